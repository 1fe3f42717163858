// SPDX-License-Identifier: Apache-2.0
// Initial partitions of the surface pieces, one part per sphere, before spheres are fitted.
#pragma once

#include "engine/model/cover_pieces.h"

#include <functional>
#include <utility>

namespace fathom {

using CoverShare = std::vector<uint32_t>; // indices of pieces

// Partition by the finest cube grid in which at most `most` cubes contain the middle of a piece.
std::vector<CoverShare> gridShares(const std::vector<CoverPiece>& pieces, size_t most);

// Splits the worst part across the longest side of its box until there are `most` parts or none can be split.
// `badness` ranks the parts.
std::vector<CoverShare> splitShares(const std::vector<CoverPiece>& pieces, size_t most,
                                    const std::function<double(const CoverShare&)>& badness);

// Pieces with their middles on either side of a plane across the longest side of the part's box; the second
// is empty if it cannot be split.
std::pair<CoverShare, CoverShare> halvesOf(const std::vector<CoverPiece>& pieces, const CoverShare& share);

// Centre of the bounding box of a part's corners [m].
dvec3 middleOf(const std::vector<CoverPiece>& pieces, const CoverShare& share);

} // namespace fathom
