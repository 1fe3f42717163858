// SPDX-License-Identifier: Apache-2.0
// Greedy set cover: the sphere that holds most of what is not held yet, again and again.
#pragma once

#include "engine/model/piece_groups.h"

namespace fathom {

// Spheres about seats, each of radius depth + protrusion [m], that hold every piece; pieces that no seat can
// hold get spheres of their own where `protrusion` allows one. Empty when more than `most` would be needed or
// some piece cannot be held.
std::vector<Sphere> greedyCover(const PieceGroups& groups, const std::vector<CoverSeat>& seats,
                                double protrusion, size_t most);

} // namespace fathom
