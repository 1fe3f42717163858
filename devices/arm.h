// SPDX-License-Identifier: Apache-2.0
// What an arm's driver gives and takes, whatever is on the line.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace fathom {

inline constexpr size_t kMostArmAxes = 8; // joints of the chain, then the grasp

// What an arm's driver is to do next.
struct ArmCommand {
    std::array<double, kMostArmAxes> position{}; // [rad], [m]; of the axes in the driver's order
    bool hold = true;                            // stand still, whatever the positions say
};

// What is known of the arm: measured, not asked for.
struct ArmFeedback {
    std::array<double, kMostArmAxes> position{}; // [rad], [m]; of the last good answer of each axis
    std::array<double, kMostArmAxes> current{};  // [A]
    double age = 0.0;                            // [s] of the oldest axis; infinite before all have answered
    bool homed = false;                          // positions mean something
    bool holding = true; // the driver holds: it was told to, feedback is stale, a motor draws too much
    bool stale = true;
    bool overloaded = false; // latched until reset
    uint64_t damaged = 0;    // frames dropped
};

// One thread, paced by the caller. Never blocks.
class ArmDevice {
public:
    virtual ~ArmDevice() = default;
    // Reads what came, then sends the next commands. now [s]: any monotonic clock. noexcept: a line that is
    // gone shows as feedback that ages.
    virtual void step(double now, const ArmCommand& command) noexcept = 0;
    virtual const ArmFeedback& feedback() const noexcept = 0;
    // Lets an overloaded arm move again.
    virtual void reset() noexcept = 0;
};

} // namespace fathom
