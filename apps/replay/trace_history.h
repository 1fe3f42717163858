// SPDX-License-Identifier: Apache-2.0
// A whole run in constant memory: minima and maxima over equal groups of ticks, fine enough for a plot.
#pragma once

#include "engine/cycle/step_record.h"

#include <array>
#include <cstddef>
#include <vector>

namespace fathom {

inline constexpr size_t kStepStates = static_cast<size_t>(StepState::Waiting) + 1;

// A group of consecutive ticks. A maximum below its minimum means that it has no finite value.
struct TraceBin {
    double begin = 0.0, end = 0.0;                    // [s] times of the first and of the last tick
    double forceMin = 0.0, forceMax = -1.0;           // [N] norm of the delivered force
    double torqueMin = 0.0, torqueMax = -1.0;         // [N m] norm of the delivered torque
    double restForceMin = 0.0, restForceMax = -1.0;   // [N] norm of the part that the device cannot render
    double restTorqueMin = 0.0, restTorqueMax = -1.0; // [N m]
    double guidance = 0.0;                            // largest guidance weight w, 0..1
    std::array<uint32_t, kStepStates> states{};       // ticks in each state
    uint32_t ticks = 0;
    uint32_t newFrames = 0; // ticks that were the first to use a new frame

    uint32_t in(StepState state) const { return states[static_cast<uint8_t>(state)]; }
};

// Keeps at most `capacity` bins. When all are used, merges neighbours, so that each bin covers twice as many
// ticks; peaks are kept. A run shorter than the capacity has one tick per bin and is exact.
class TraceHistory {
public:
    explicit TraceHistory(size_t capacity = 16384); // even, at least 2
    void add(const StepRecord& tick);

    const std::vector<TraceBin>& bins() const { return bins_; }
    uint64_t ticks() const { return ticks_; }
    uint64_t newFrames() const { return newFrames_; }

    struct Peak {
        double value = 0.0, t = 0.0; // [N] or [N m], [s]
    };
    const Peak& forcePeak() const { return forcePeak_; }
    const Peak& torquePeak() const { return torquePeak_; }
    const Peak& restForcePeak() const { return restForcePeak_; }
    const Peak& restTorquePeak() const { return restTorquePeak_; }

private:
    void halve();

    size_t capacity_;
    uint64_t stride_ = 1; // ticks per bin
    std::vector<TraceBin> bins_;
    uint64_t ticks_ = 0, newFrames_ = 0;
    int64_t lastFrame_ = -1;
    Peak forcePeak_, torquePeak_, restForcePeak_, restTorquePeak_;
};

} // namespace fathom
