// SPDX-License-Identifier: Apache-2.0
// The interface of arm drivers, independent of the protocol on the line.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace fathom {

inline constexpr size_t kMaxArmAxes = 13; // chain joints, then the grasp

// The next command for an arm's driver.
struct ArmCommand {
    std::array<double, kMaxArmAxes> position{}; // [rad] or [m], axes in the driver's order
    bool hold = true;                           // stop and hold; positions are ignored
};

// Measured state of the arm.
struct ArmFeedback {
    std::array<double, kMaxArmAxes> position{}; // [rad] or [m], last valid reading of each axis
    std::array<double, kMaxArmAxes> current{};  // [A]
    double age = 0.0;    // [s] age of the oldest reading; infinite until every axis has answered
    bool homed = false;  // positions are absolute
    bool holding = true; // the driver holds: on command, stale feedback or overcurrent
    bool stale = true;
    int lacksCurrent = -1;   // stale because of this axis, which reports no motor current; -1 = none
    bool overloaded = false; // latched until reset
    uint64_t damaged = 0;    // damaged frames, dropped
};

// One thread, paced by the caller. Never blocks.
class ArmDevice {
public:
    virtual ~ArmDevice() = default;
    // Reads pending input, then sends the next commands. now [s]: any monotonic clock. noexcept: after the
    // line is lost, the feedback only ages.
    virtual void step(double now, const ArmCommand& command) noexcept = 0;
    virtual const ArmFeedback& feedback() const noexcept = 0;
    // Clears a latched overload.
    virtual void reset() noexcept = 0;
};

} // namespace fathom
