// SPDX-License-Identifier: Apache-2.0
// A real arm as the window shows it: where it was measured, against where the tool's springs have it.
#pragma once

#include "apps/operate/run_view.h"
#include "engine/cycle/arm_rig.h"

#include <string>
#include <vector>

namespace fathom::operate {

struct MeasuredArm {
    bool real = false;  // one follows the tool
    bool known = false; // measured now; else the rest is of the last time
    ArmState state = ArmState::Held;
    std::vector<double> joints;  // [rad], [m]; empty = never measured
    std::vector<Sphere> spheres; // of every link, base frame
    dvec3 tip{0.0};              // base frame
    double apart = 0.0;          // [m] farthest that one of them is from where the tool's arm has it
    std::string worst;           // joint that is farthest off
    double error = 0.0;          // of it, measured less wanted [rad], or [m] where it slides
    bool slides = false;
    double age = 0.0; // [s] since it was measured

    // Worth a mark over the views: on its place it would only hide things.
    bool isOff() const { return !joints.empty() && (!known || apart > kOff); }
    static constexpr double kOff = 0.01; // [m]
};

// arm: null = the scene has none. wanted: its spheres where the tool has it.
MeasuredArm measuredArm(const ArmRig* arm, const RunView& run, std::span<const Sphere> wanted);

// What of the arm itself holds the tool in this turn, a phrase each: joints at their limits or their full
// speed, a singular posture, jaws that would enter a region. Empty without an arm.
std::vector<std::string> armHolds(const ArmRig* arm, const StepRecord& tick);

} // namespace fathom::operate
