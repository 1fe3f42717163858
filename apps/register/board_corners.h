// SPDX-License-Identifier: Apache-2.0
// The inner corners of a chessboard in a grey picture.
#pragma once

#include <cstdint>
#include <glm/vec2.hpp>
#include <span>
#include <vector>

namespace fathom {

// Columns x rows of inner corners, row by row, in the board's own order: the first corner is the one whose
// square beyond it (outside of all inner corners) is dark; columns run to the right and rows down where the
// board is read that way. columns + rows must be odd: else a board turned by half looks the same. Pixel
// centres are whole numbers. Empty when not all are seen as one grid, or the grid is larger. Corners are
// found by the ring of ChESS (S. Bennett and J. Lasenby, ChESS - Quick and robust detection of chess-board
// features, 2014), placed by the saddle of a quadric.
std::vector<glm::dvec2> boardCorners(std::span<const uint8_t> grey, uint32_t width, uint32_t height,
                                     uint32_t columns, uint32_t rows);

} // namespace fathom
