// SPDX-License-Identifier: Apache-2.0
// What passes between the haptic thread and the thread that speaks to a real arm: mailboxes, no locks.
#pragma once

#include "apps/binding/posture_track.h"
#include "engine/types/triple_buffer.h"

#include <limits>

namespace fathom {

enum class ArmState : uint8_t {
    Follows,    // goes where the tool's arm goes
    Held,       // could, but was told to stand still: forces off, old scene, trapped, no wish lately
    Silent,     // no fresh feedback
    Gone,       // the line is: unplugged
    NotHomed,   // its positions mean nothing any more; only a new start homes it
    Overloaded, // a motor drew too much; forces off and on let it move again
    Behind,     // too far from where it should be, for too long: it is held until the tool is where it is
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
    bool off = true;         // forces are off: what is latched may go
    PostureTrack::Time at{}; // of the turn
};

struct ArmStatus { // arm -> haptic
    ArmState state = ArmState::Silent;
    bool known = false;                                   // the posture is fresh and means something
    ArmPosture posture;                                   // measured
    double age = std::numeric_limits<double>::infinity(); // [s] of the oldest axis
    double lag = 0.0;                                     // farthest joint behind, over what is allowed
    uint64_t damaged = 0;                                 // frames dropped on the line
    uint64_t reopened = 0;                                // times that the line came back
    PostureTrack::Time at{};                              // of the exchange
};

struct ArmLink {
    TripleBuffer<ArmSetpoint> setpoint;
    TripleBuffer<ArmStatus> told;
    PostureTrack measured; // arm -> frame
};

} // namespace fathom
