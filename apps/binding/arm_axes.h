// SPDX-License-Identifier: Apache-2.0
// Maps the axes of an arm's driver to the joints of the scene's arm and converts their readings.
#pragma once

#include "devices/arm.h"
#include "engine/cycle/arm_setup.h"
#include "engine/scene/scene.h"

#include <optional>
#include <vector>

namespace fathom {

// Immutable after armAxes(). Functions are noexcept and do not allocate.
struct ArmAxes {
    struct Joint { // q = zero + sign * position
        size_t axis = 0;
        double sign = 1.0, zero = 0.0;
        double mostLag = 0.35; // [rad], [m] lag behind the setpoint; exceeded for longer, the arm is held
    };
    struct Jaws {
        size_t axis = 0;
        double open = 0.0, closed = 0.0;
    };
    std::vector<Joint> joints; // of the chain, base to tip
    std::optional<Jaws> jaws;

    ArmPosture
    postureOf(const ArmFeedback& feedback) const noexcept; // without jaws the grasp is NaN (unknown)
    // Writes the positions of these axes; others stay as they are.
    void command(const ArmPosture& posture, ArmCommand& out) const noexcept;
    // Largest ratio of a joint's lag to its mostLag.
    double lag(const ArmPosture& wanted, const ArmPosture& measured) const noexcept;
};

// One axis per joint of the chain, in its order; no jaws.
ArmAxes chainAxes(const ArmModel& model);

// Name of a driver's axis, as scenes have it.
const char* armAxisName(SceneArm::Driver::Protocol protocol, size_t axis) noexcept;

// The scene's arm has a driver. Throws BadInput with the scene's field for unknown axes or joints and for
// joints without an axis.
ArmAxes armAxes(const Scene& scene, const ArmSetup& setup);

} // namespace fathom
