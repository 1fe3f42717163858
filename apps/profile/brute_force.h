// SPDX-License-Identifier: Apache-2.0
// Every leaf against every sphere: the kernel that any query must beat. The same float32 test as the queries.
#pragma once

#include "engine/contact/fixtures.h"
#include "engine/contact/tool.h"

#include <cstdint>
#include <vector>

namespace fathom::profile {

// Indices, ascending, of the spheres with d^2 <= (reach + r_t + R)^2 for some leaf. Allocates `found` only.
void bruteForceCull(const PosedLeaves& leaves, float reach, const RegionSpheres& spheres,
                    std::vector<uint8_t>& marks, std::vector<uint32_t>& found);

} // namespace fathom::profile
