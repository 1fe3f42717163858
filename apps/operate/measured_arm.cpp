// SPDX-License-Identifier: Apache-2.0
#include "apps/operate/measured_arm.h"

#include "apps/operate/view_marks.h"

#include <algorithm>
#include <cmath>

namespace fathom::operate {

ShownArm measuredArm(const ArmSetup* arm, const RunView& run, std::span<const Sphere> wanted) {
    ShownArm measured;
    const TickRow& row = run.step();
    if (arm == nullptr || !row.driven) {
        return measured;
    }
    measured.real = true;
    measured.known = row.armStatus.known;
    measured.state = row.armStatus.state;
    if (!run.measured()) {
        return measured;
    }
    ArmPosture posture = run.measured()->posture;
    const ArmPosture& tool = row.record.arm.posture;
    posture.grasp = std::isfinite(posture.grasp) ? posture.grasp : tool.grasp; // jaws without a drive
    measured.age = std::max(0.0, row.record.t - run.measured()->t);
    measured.spheres = armSpheres(arm, posture);
    measured.tip = arm->tipAt(posture).position;
    for (size_t i = 0; i < std::min(wanted.size(), measured.spheres.size()); ++i) {
        measured.apart =
            std::max(measured.apart, glm::distance(measured.spheres[i].centre, wanted[i].centre));
    }
    for (size_t k = 0; k < arm->model.joints.size(); ++k) {
        const double error = posture.q[k] - tool.q[k];
        measured.joints.push_back(posture.q[k]);
        if (k == 0 || std::abs(error) > std::abs(measured.error)) {
            measured.error = error;
            measured.worst = arm->model.joints[k].name;
            measured.slides = arm->model.joints[k].slides;
        }
    }
    return measured;
}

std::vector<std::string> armHolds(const ArmSetup* arm, const StepRecord& tick) {
    constexpr double kAt = 1e-4; // [rad], [m]
    std::vector<std::string> holds;
    if (arm == nullptr) {
        return holds;
    }
    for (size_t k = 0; tick.arm.atLimits > 0 && k < arm->model.joints.size(); ++k) {
        const ArmJoint& joint = arm->model.joints[k];
        const double q = tick.arm.posture.q[k];
        if (q > joint.upper - kAt || q < joint.lower + kAt) {
            holds.push_back(joint.name + " at its " + (q > joint.upper - kAt ? "upper" : "lower") + " limit");
        }
    }
    if (tick.arm.atLimits > 0 && holds.empty()) {
        holds.emplace_back("joints at full speed");
    }
    if (tick.arm.singular) {
        holds.emplace_back("arm near a singularity: it moves slowly");
    }
    if (tick.arm.graspHeld) {
        holds.emplace_back("jaws held: a finger would enter a region");
    }
    return holds;
}

} // namespace fathom::operate
