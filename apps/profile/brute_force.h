// SPDX-License-Identifier: Apache-2.0
// Tests every leaf against every sphere. This is the baseline that every query must beat, with the same
// float32 test.
#pragma once

#include "engine/contact/host_fixtures.h"
#include "engine/contact/tool.h"

#include <cstdint>
#include <vector>

namespace fathom::profile {

// Ascending indices of the spheres with d^2 <= (reach + r_t + R)^2 for some leaf. Allocates only in `found`.
void bruteForceCull(const PosedLeaves& leaves, float reach, const RegionSpheres& spheres,
                    std::vector<uint8_t>& marks, std::vector<uint32_t>& found);

} // namespace fathom::profile
