// SPDX-License-Identifier: Apache-2.0
// Greedy set cover: repeatedly takes the sphere that contains most of the pieces not yet covered.
#pragma once

#include "engine/model/piece_groups.h"

namespace fathom {

// Returns spheres about the candidates, each of radius depth + protrusion [m], that contain every piece. A
// piece that no candidate can contain gets its own sphere where `protrusion` allows it. Empty when more than
// `most` spheres are needed or some piece cannot be contained.
std::vector<Sphere> greedyCover(const PieceGroups& groups, const std::vector<CoverCentre>& centres,
                                double protrusion, size_t most);

} // namespace fathom
