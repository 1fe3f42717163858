// SPDX-License-Identifier: Apache-2.0
#include "engine/model/arm_model.h"

namespace fathom {

namespace {

Pose movedBy(const dvec3& axis, bool slides, double q) {
    return slides ? Pose{q * axis, {1.0, 0.0, 0.0, 0.0}} : Pose{dvec3(0.0), rotationExp(q * axis)};
}

} // namespace

void ArmModel::place(const JointVector& q, const Pose& worldTbase, ArmFrames& frames,
                     double grasp) const noexcept {
    frames[0] = worldTbase;
    for (size_t k = 0; k < joints.size(); ++k) {
        const ArmJoint& joint = joints[k];
        frames[k + 1] = frames[k] * joint.before * movedBy(joint.axis, joint.slides, q[k]);
        frames[k + 1].rotation = glm::normalize(frames[k + 1].rotation);
    }
    for (size_t f = 0; f < fingers.size(); ++f) {
        const ArmFinger& finger = fingers[f];
        const double at = finger.open + grasp * (finger.closed - finger.open);
        frames[kMostJoints + 1 + f] =
            frames[finger.joint] * finger.before * movedBy(finger.axis, finger.slides, at);
    }
}

dvec3 ArmModel::motionOf(const ArmFrames& frames, size_t k, const dvec3& point) const noexcept {
    const dvec3 axis = axisOf(frames, k);
    return joints[k].slides ? axis : glm::cross(axis, point - frames[k + 1].position);
}

} // namespace fathom
