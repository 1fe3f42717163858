// SPDX-License-Identifier: Apache-2.0
// The state of a run as diagnostic_msgs/msg/DiagnosticArray: "fathom: forces", "fathom: camera", "fathom:
// haptic", and "fathom: arm" if a real arm follows.
#pragma once

#include "apps/binding/ros2_tick.h"

namespace fathom {

// One thread.
class Ros2Diagnosis {
public:
    // Of the newest step. Rates are since the previous call.
    std::vector<ros2::Diagnosis> of(const Ros2Tick& tick, uint64_t unsent);

private:
    RunTotals before_;
    uint64_t time_ = 0; // [ns] of the previous call; 0 = none
};

} // namespace fathom
