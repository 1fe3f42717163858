// SPDX-License-Identifier: Apache-2.0
// Fits the pose that maps one point set onto another, with its residual.
#pragma once

#include "engine/types/pose.h"

#include <span>
#include <string>

namespace fathom {

struct PointPair {
    dvec3 camera{0.0}, base{0.0}; // [m] the same point in both frames
    std::string name;             // for messages
};

struct RigidFit {
    Pose baseTcamera;
    double sigma = 0.0; // [m] standard deviation of the pairs, by the remaining degrees of freedom
    double turn = 0.0;  // [rad] standard deviation of the rotation, about the axis that the pairs fix least
    double worst = 0.0; // [m] largest distance
    std::string worstName;
};

// Least squares over three or more pairs that are not on one line, which the caller checks.
Pose poseOf(std::span<const PointPair> pairs);

// Least squares (B. K. P. Horn, Closed-form solution of absolute orientation using unit quaternions, 1987).
// Throws BadInput, that names `source`, for fewer than 4 pairs or collinear points (within 1 mm).
RigidFit fitRigid(std::span<const PointPair> pairs, const std::string& source);

} // namespace fathom
