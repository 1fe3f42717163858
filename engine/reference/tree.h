// SPDX-License-Identifier: Apache-2.0
// Twin of shaders/tree.comp and the validator of bounds.
#pragma once

#include "engine/reference/spheres.h"
#include "engine/scene/plan.h"

#include <string>

namespace fathom::reference {

// The nodes of a level (1 = patches, ..., last = root), row-major, from the bounds of the level below: centre
// = mean of all points below, radius = max(|c_k - centre| + r_k) over at most 4x4 children (paper eq. 3).
std::vector<Bound> parents(const PatchLayout& layout, size_t level, const std::vector<Bound>& below);

// Empty when the levels from 0 on are valid: every used child inside its parent (float64, no tolerance),
// correct counts, and empty nodes with radius < 0 and count 0.
std::string validateTree(const PatchLayout& layout, const std::vector<std::vector<Bound>>& levels);

} // namespace fathom::reference
