// SPDX-License-Identifier: Apache-2.0
// Rigid poses and rotation vectors, float64. A pose is a_T_b: it maps points of frame b to frame a.
#pragma once

#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>

namespace fathom {

using glm::dquat; // constructor order w, x, y, z
using glm::dvec3;

struct Pose {
    dvec3 position{0.0};                // [m]
    dquat rotation{1.0, 0.0, 0.0, 0.0}; // unit, w x y z

    dvec3 apply(const dvec3& point) const { return position + rotation * point; }
};

// a_T_c from a_T_b and b_T_c.
inline Pose operator*(const Pose& aTb, const Pose& bTc) {
    return {aTb.apply(bTc.position), aTb.rotation * bTc.rotation};
}

// b_T_a from a_T_b.
inline Pose inverse(const Pose& aTb) {
    const dquat inv = glm::conjugate(aTb.rotation);
    return {inv * -aTb.position, inv};
}

// Rotation vector [rad] of a unit quaternion by the shortest arc: |result| <= pi. Accurate for tiny angles.
dvec3 rotationLog(const dquat& q) noexcept;

// Rotation vector [rad] that turns a into b by the shortest arc, in the frame in which both are given. Unit
// quaternions.
dvec3 rotationBetween(const dquat& a, const dquat& b) noexcept;

// Unit quaternion of a rotation vector [rad].
dquat rotationExp(const dvec3& v) noexcept;

// The unit quaternion of q, whose components are finite and not all 0, of any size.
dquat unitOf(const dquat& q) noexcept;

// Interpolates between a (s = 0) and b (s = 1) on a straight line and the shortest arc.
Pose interpolate(const Pose& a, const Pose& b, double s) noexcept;

// All numbers finite and the quaternion of non-zero length.
bool isFinite(const Pose& pose) noexcept;
bool isFinite(const dvec3& v) noexcept;

// Finite and at most kFarthestPose from the origin of its frame: farther away, differences could overflow.
bool isUsable(const Pose& pose) noexcept;
inline constexpr double kFarthestPose = 1e6; // [m]

} // namespace fathom
