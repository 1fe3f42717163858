// SPDX-License-Identifier: Apache-2.0
#include "engine/types/pose.h"

#include <algorithm>
#include <cmath>

namespace fathom {

dvec3 rotationLog(const dquat& q) noexcept {
    const double sign = q.w < 0.0 ? -1.0 : 1.0; // q and -q are the same rotation: take the shorter arc
    const dvec3 v = sign * dvec3(q.x, q.y, q.z);
    const double s = glm::length(v);
    const double w = sign * q.w;
    if (s < 1e-12) {
        return v * 2.0; // sin(a/2) = a/2 to the last digit; also covers zero
    }
    return v * (2.0 * std::atan2(s, w) / s);
}

dvec3 rotationBetween(const dquat& a, const dquat& b) noexcept {
    return rotationLog(b * glm::conjugate(a));
}

dquat rotationExp(const dvec3& v) noexcept {
    const double angle = glm::length(v);
    // series of sin(a/2)/a near zero, where the quotient loses digits
    const double k = angle < 1e-6 ? 0.5 - angle * angle / 48.0 : std::sin(0.5 * angle) / angle;
    return glm::normalize(dquat(std::cos(0.5 * angle), v.x * k, v.y * k, v.z * k));
}

// Scales first: squares of huge or tiny numbers would overflow or underflow.
dquat unitOf(const dquat& q) noexcept {
    const double largest = std::max({std::abs(q.w), std::abs(q.x), std::abs(q.y), std::abs(q.z)});
    return glm::normalize(dquat(q.w / largest, q.x / largest, q.y / largest, q.z / largest));
}

Pose interpolate(const Pose& a, const Pose& b, double s) noexcept {
    const dvec3 arc = rotationBetween(a.rotation, b.rotation);
    return {a.position + s * (b.position - a.position), rotationExp(s * arc) * a.rotation};
}

bool isFinite(const dvec3& v) noexcept {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

bool isFinite(const Pose& pose) noexcept {
    const dquat& q = pose.rotation;
    const double norm = glm::dot(q, q);
    return isFinite(pose.position) && std::isfinite(norm) && norm > 0.0;
}

bool isUsable(const Pose& pose) noexcept {
    return isFinite(pose) && glm::length(pose.position) <= kFarthestPose;
}

} // namespace fathom
