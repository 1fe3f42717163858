// SPDX-License-Identifier: Apache-2.0
// The last step of a sphere cover: more spheres where it protrudes most.
#pragma once

#include "engine/model/cover_fit.h"

namespace fathom {

// Splits the sphere that protrudes most, with leaves that are left or that merging two others frees, until
// that gains nothing. The result contains all pieces, has at most `leaves` spheres and protrudes no farther.
std::vector<Sphere> refinedCover(const CoverFitting& f, const std::vector<Sphere>& spheres, uint32_t leaves);

} // namespace fathom
