// SPDX-License-Identifier: Apache-2.0
// Finds the inner corners of a chessboard in a grey image.
#pragma once

#include <cstdint>
#include <glm/vec2.hpp>
#include <span>
#include <vector>

namespace fathom {

// Columns x rows of inner corners, row by row, in the board's own order: the first corner is the one whose
// square beyond it (outside of all inner corners) is dark; columns run to the right and rows down where the
// board is read that way. columns + rows must be odd, because otherwise a board rotated by 180 degrees looks
// the same. Pixel centres are whole numbers. Empty when not all corners form one grid, or the grid is larger.
// Corners are found by the ring of ChESS (S. Bennett and J. Lasenby, ChESS - Quick and robust detection of
// chess-board features, 2014), placed by the saddle of a quadric.
std::vector<glm::dvec2> boardCorners(std::span<const uint8_t> grey, uint32_t width, uint32_t height,
                                     uint32_t columns, uint32_t rows);

} // namespace fathom
