// SPDX-License-Identifier: Apache-2.0
// Reader and writer of .sph, the text format of the Sphere-Tree Toolkit (Bradshaw and O'Sullivan 2004).
#pragma once

#include "engine/types/sphere_tree.h"

#include <filesystem>

namespace fathom {

// Largest number of slots per tree, used or not: bounds the memory that a file can request.
inline constexpr uint32_t kMaxSphNodes = 1u << 20;

// Reads "levels degree", then one node per line (x y z r, further columns ignored), breadth first; text after
// the last node is ignored. Lengths are taken as metres times `metresPerUnit`. The result always satisfies
// the invariants of SphereTree: slots under an unused slot are unused, a used node without used children is
// repeated down to the last level, radii above the last level are recomputed to enclose the children. Throws
// BadInput with file and line.
SphereTree readSph(const std::filesystem::path& file, double metresPerUnit = 1.0);

// Writes x y z r occupancy with 17 significant digits, so that readSph gives the leaves back bit by bit.
// Throws Error when the tree is unsound or the file cannot be written.
void writeSph(const SphereTree& tree, const std::filesystem::path& file);

} // namespace fathom
