// SPDX-License-Identifier: Apache-2.0
// Ways to share the pieces of a surface out among spheres, before any sphere is fitted.
#pragma once

#include "engine/model/cover_pieces.h"

#include <functional>

namespace fathom {

using CoverShare = std::vector<uint32_t>; // of the pieces

// The finest grid of cubes over the pieces' box with at most `most` cubes that hold the middle of a piece.
std::vector<CoverShare> gridShares(const std::vector<CoverPiece>& pieces, size_t most);

// Halves the worst share across the longest side of its box until there are `most` or none can be halved;
// `badness` says how bad a share is.
std::vector<CoverShare> splitShares(const std::vector<CoverPiece>& pieces, size_t most,
                                    const std::function<double(const CoverShare&)>& badness);

// Middle of the box of a share's corners [m].
dvec3 middleOf(const std::vector<CoverPiece>& pieces, const CoverShare& share);

} // namespace fathom
