// SPDX-License-Identifier: Apache-2.0
#include "engine/model/arm_model.h"

namespace fathom {

void ArmModel::place(const JointVector& q, const Pose& worldTbase, ArmFrames& frames) const noexcept {
    frames[0] = worldTbase;
    for (size_t k = 0; k < joints.size(); ++k) {
        const ArmJoint& joint = joints[k];
        Pose move;
        if (joint.slides) {
            move.position = q[k] * joint.axis;
        } else {
            move.rotation = rotationExp(q[k] * joint.axis);
        }
        frames[k + 1] = frames[k] * joint.before * move;
        frames[k + 1].rotation = glm::normalize(frames[k + 1].rotation);
    }
}

dvec3 ArmModel::motionOf(const ArmFrames& frames, size_t k, const dvec3& point) const noexcept {
    const dvec3 axis = axisOf(frames, k);
    return joints[k].slides ? axis : glm::cross(axis, point - frames[k + 1].position);
}

} // namespace fathom
