// SPDX-License-Identifier: Apache-2.0
#include "engine/model/arm_model.h"

namespace fathom {

namespace {

constexpr double kAnyPosture = 0.731;       // [rad], [m]
constexpr double kLeastDisplacement = 1e-6; // [m / rad] slower points stay where they are

Pose movedBy(const dvec3& axis, bool slides, double q) {
    return slides ? Pose{q * axis, {1.0, 0.0, 0.0, 0.0}} : Pose{dvec3(0.0), rotationExp(q * axis)};
}

double valueOf(const ArmMimic& mimic, const JointVector& q) {
    return mimic.offset + mimic.multiplier * q[mimic.joint];
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
        const double at =
            finger.mimic ? valueOf(*finger.mimic, q) : finger.open + grasp * (finger.closed - finger.open);
        const Pose& carrier = frames[finger.carrier == 0 ? finger.joint : kMaxJoints + finger.carrier];
        frames[kMaxJoints + 1 + f] = carrier * finger.before * movedBy(finger.axis, finger.slides, at);
    }
}

bool ArmModel::moves(size_t leaf) const noexcept {
    JointVector q{}; // a posture of no symmetry: what is on an axis there is on it everywhere
    for (size_t k = 0; k < count(); ++k) {
        q[k] = kAnyPosture * (1.0 + 0.37 * static_cast<double>(k));
    }
    ArmFrames frames;
    place(q, Pose{}, frames, 0.5 * kAnyPosture);
    const dvec3 at = centre(frames, leaf);
    const auto displaces = [&](size_t k, const dvec3& motion) {
        const ArmJoint& joint = joints[joints[k].mimic ? joints[k].mimic->joint : k];
        return joint.lower < joint.upper && glm::length(motion) > kLeastDisplacement;
    };
    for (size_t k = 0; k < leaves[leaf].joint; ++k) {
        if (displaces(k, motionOf(frames, k, at))) {
            return true;
        }
    }
    for (uint32_t f = leaves[leaf].finger; f > 0; f = fingers[f - 1].carrier) {
        const dvec3 motion = motionOfFinger(frames, f - 1, at);
        const auto& mimic = fingers[f - 1].mimic;
        if (mimic ? displaces(mimic->joint, motion) : glm::length(motion) > kLeastDisplacement) {
            return true;
        }
    }
    return false;
}

void ArmModel::follow(JointVector& q) const noexcept {
    for (size_t k = 0; k < joints.size(); ++k) {
        q[k] = joints[k].mimic ? valueOf(*joints[k].mimic, q) : q[k];
    }
}

dvec3 ArmModel::motionOf(const ArmFrames& frames, size_t k, const dvec3& point) const noexcept {
    const dvec3 axis = axisOf(frames, k);
    return joints[k].slides ? axis : glm::cross(axis, point - frames[k + 1].position);
}

dvec3 ArmModel::motionOfFinger(const ArmFrames& frames, size_t f, const dvec3& point) const noexcept {
    const Pose& frame = frames[kMaxJoints + 1 + f];
    const dvec3 axis = frame.rotation * fingers[f].axis;
    return fingers[f].slides ? axis : glm::cross(axis, point - frame.position);
}

} // namespace fathom
