// SPDX-License-Identifier: Apache-2.0
// The pose that maps one set of points onto another, and how well it does.
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
    double sigma =
        0.0; // [m] root of the mean square distance of the pairs, for the degrees of freedom that are left
    double worst = 0.0; // [m] largest distance
    std::string worstName;
};

// Least squares (B. K. P. Horn, Closed-form solution of absolute orientation using unit quaternions, 1987).
// Throws BadInput, naming `source`, for fewer than 4 pairs or points that lie on one line (within 1 mm).
RigidFit fitRigid(std::span<const PointPair> pairs, const std::string& source);

} // namespace fathom
