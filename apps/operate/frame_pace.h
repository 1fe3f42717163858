// SPDX-License-Identifier: Apache-2.0
// How often the window draws: 60 times per second, or less where its frames take more than their share of a
// core from a device that is the CPU itself.
#pragma once

namespace fathom::operate {

// Window thread.
class FramePace {
public:
    static constexpr double kFastest = 1.0 / 60.0, kSlowest = 1.0 / 10.0; // [s] periods
    static constexpr double kShare =
        0.22; // of a core, for the window's thread; showing takes the rest of 25 %

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
