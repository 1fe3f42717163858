// SPDX-License-Identifier: Apache-2.0
// Guidance classes that ask for more than a plain mean: the largest connected part, a trimmed mean. On the
// CPU, from the copied points; built only for scenes that ask.
#pragma once

#include "engine/cloud/fixture_set.h"
#include "engine/cloud/guidance_pose.h"

namespace fathom::cloud {

// Moments about the origin of the points of class bit c that are left after fixture.largestPart (8-connected
// pixels whose depths differ by at most edge, relative; 0 = any; of parts as large the one that
// begins first, row by row) and fixture.trim (that share of the points
// farthest from the mean is left out).
Moments chosenMoments(const FixtureSet& set, uint32_t c, const FixtureClass& fixture, double edge,
                      const PatchLayout& layout);

} // namespace fathom::cloud
