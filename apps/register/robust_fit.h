// SPDX-License-Identifier: Apache-2.0
// A rigid fit that reports outliers, and rejects the whole if there are too many.
#pragma once

#include "apps/register/rigid_fit.h"

#include <string>
#include <vector>

namespace fathom {

struct RobustFit {
    struct Outlier {
        std::string name;      // of the pair
        double distance = 0.0; // [m] from the fit
    };
    RigidFit fit;                  // of the inliers
    std::vector<Outlier> outliers; // farthest first
    bool flat = false;             // a mirror image of the inliers fits as well: it would not be noticed
    std::string rejection;         // why the fit must not be used, with the worst pairs; empty = it may
};

// What to accept.
struct FitLimits {
    double residual = 0.02;    // [m] standard deviation of the inliers, and the farthest inlier
    double outlierShare = 0.0; // of all pairs; a larger share rejects the fit
};

// Least median of squares over triples of pairs (P. J. Rousseeuw, 1984), then least squares of the inliers.
// Rejects by scale, a mirrored axis, outliers, the residual and the rotation. Deterministic. Throws like
// fitRigid().
RobustFit fitRobust(std::span<const PointPair> pairs, const FitLimits& limits, const std::string& source);

} // namespace fathom
