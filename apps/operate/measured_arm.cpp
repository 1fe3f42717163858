// SPDX-License-Identifier: Apache-2.0
#include "apps/operate/measured_arm.h"

#include "apps/operate/view_marks.h"

#include <algorithm>
#include <cmath>

namespace fathom::operate {

MeasuredArm measuredArm(const ArmRig* arm, const RunView& run, std::span<const Sphere> wanted) {
    MeasuredArm measured;
    const TurnRow& row = run.turn();
    if (arm == nullptr || !row.driven) {
        return measured;
    }
    measured.real = true;
    measured.known = row.told.known;
    measured.state = row.told.state;
    if (!run.measured()) {
        return measured;
    }
    ArmPosture posture = run.measured()->posture;
    const ArmPosture& tool = row.record.arm.posture;
    posture.grasp = std::isfinite(posture.grasp) ? posture.grasp : tool.grasp; // jaws that nobody moves
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

} // namespace fathom::operate
