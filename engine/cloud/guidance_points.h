// SPDX-License-Identifier: Apache-2.0
// Guidance options beyond the plain mean: largest connected part and trimmed mean. Computed on the CPU from
// copied points, only for scenes that use them.
#pragma once

#include "engine/cloud/fixture_set.h"
#include "engine/cloud/guidance_pose.h"

namespace fathom::cloud {

// Moments, relative to the set's origin, of the points of class bit c after two filters. fixture.largestPart
// keeps the largest part of 8-connected pixels whose depths differ by at most edge (relative; 0 = any); of
// equal parts, the first in row-major order. fixture.trim then drops this share of the points, those farthest
// from the mean.
// untrimmed: points before the second filter.
Moments chosenMoments(const FixtureSet& set, uint32_t c, const FixtureClass& fixture, double edge,
                      const PatchLayout& layout, size_t& untrimmed);

} // namespace fathom::cloud
