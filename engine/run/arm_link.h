// SPDX-License-Identifier: Apache-2.0
// Lock-free mailboxes between the haptic thread and the thread of a real arm.
#pragma once

#include "engine/run/posture_track.h"
#include "engine/types/triple_buffer.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace fathom {

enum class ArmState : uint8_t {
    Follows,    // tracks the arm of the tool
    Held,       // ready, but commanded to hold: forces off, old scene, trapped, no recent setpoint
    Silent,     // no fresh feedback
    Gone,       // the line is unplugged
    NotHomed,   // its positions are invalid until a new start homes the arm
    Overloaded, // a motor drew too much current; switching forces off and on clears this
    Behind,     // lagged too far for too long; held until the tool is where the arm is
};
inline constexpr size_t kArmStates = 7;

constexpr const char* armStateName(ArmState state) {
    constexpr const char* kNames[kArmStates] = {"follows",   "held",       "silent", "gone",
                                                "not homed", "overloaded", "behind"};
    return kNames[static_cast<size_t>(state)];
}
constexpr bool isFault(ArmState state) {
    return state > ArmState::Held;
}

struct ArmSetpoint { // haptic -> arm
    ArmPosture posture;
    bool hold = true;
    bool off = true;         // forces are off, so latched faults may clear
    PostureTrack::Time at{}; // of the step
};

struct ArmStatus { // arm -> haptic
    ArmState state = ArmState::Silent;
    bool known = false;                                   // the posture is fresh and valid
    ArmPosture posture;                                   // measured
    double age = std::numeric_limits<double>::infinity(); // [s] of the oldest axis
    double lag = 0.0;                                     // largest joint lag over the allowed one
    uint64_t damaged = 0;                                 // damaged telegrams, dropped
    uint64_t reopened = 0;                                // times that the line was opened again
    PostureTrack::Time at{};                              // of the exchange
};

struct ArmLink {
    TripleBuffer<ArmSetpoint> setpoint;
    TripleBuffer<ArmStatus> status;
    PostureTrack measured; // arm -> frame, for the self-filter

    // Arm thread. An unknown grasp (NaN) is taken from the newest setpoint that was read: the self-filter
    // must know where the fingers are, or they become a region.
    void addMeasured(PostureTrack::Time at, ArmPosture posture) noexcept {
        const double grasp = std::isfinite(posture.grasp) ? posture.grasp : setpoint.front().posture.grasp;
        posture.grasp = std::clamp(grasp, 0.0, 1.0);
        measured.add(at, posture);
    }
};

} // namespace fathom
