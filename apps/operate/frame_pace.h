// SPDX-License-Identifier: Apache-2.0
// How often the window draws: 60 times per second. On a device that is the CPU itself less often, if frames
// would take more than kShare of a core.
#pragma once

namespace fathom::operate {

// Window thread.
class FramePace {
public:
    static constexpr double kFastest = 1.0 / 60.0, kSlowest = 1.0 / 10.0; // [s] periods
    // Of a core, for the thread of the window. Presenting takes another 3 %.
    static constexpr double kShare = 0.22;

    explicit FramePace(bool limited)
        : limited_(limited) {}

    // Once per frame. cpu: CPU time of the window's thread since its start [s].
    void note(double cpu);
    double cost() const { return cost_; } // mean CPU time of a frame [s]; 0 = none yet
    double period() const;                // [s]

private:
    bool limited_;
    double before_ = -1.0, cost_ = 0.0;
};

// CPU time of the calling thread [s].
double threadCpuTime();

} // namespace fathom::operate
