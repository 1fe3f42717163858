// SPDX-License-Identifier: Apache-2.0
// A real arm as the window shows it: measured posture against the setpoint.
#pragma once

#include "apps/operate/run_view.h"
#include "engine/cycle/arm_setup.h"

#include <string>
#include <vector>

namespace fathom::operate {

struct ShownArm {
    bool real = false;  // a real arm follows the tool
    bool known = false; // measured recently; otherwise the values are the last ones
    ArmState state = ArmState::Held;
    std::vector<double> joints;  // [rad], [m]; empty = never measured
    std::vector<Sphere> spheres; // spheres of every link, base frame
    dvec3 tip{0.0};              // base frame
    double apart = 0.0;          // [m] largest distance of a sphere from its place at the setpoint
    std::string worst;           // joint with the largest error
    double error = 0.0;          // measured minus setpoint of that joint: [rad], or [m] for a sliding joint
    bool slides = false;
    double age = 0.0; // [s] age of the measurement

    // Drawn in the views only when the arm is off its setpoint; otherwise it would only cover things.
    bool isOff() const { return !joints.empty() && (!known || apart > kOff); }
    static constexpr double kOff = 0.01; // [m]
};

// arm: null = no arm in the scene. wanted: the arm's spheres at the setpoint.
ShownArm measuredArm(const ArmSetup* arm, const RunView& run, std::span<const Sphere> wanted);

// Reasons why the arm itself stops the tool in this tick, one phrase each: joints at their limits or at full
// speed, a singular posture, jaws that would enter a region. Empty without an arm.
std::vector<std::string> armHolds(const ArmSetup* arm, const StepRecord& tick);

} // namespace fathom::operate
