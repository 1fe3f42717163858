// SPDX-License-Identifier: Apache-2.0
// Depth in metres as 16-bit values.
#pragma once

#include <cstdint>

namespace fathom {

// The unit [m] for depth of up to `farthest` metres: 0.1 mm or the least multiple of it with which 16 bits
// are enough, at most kCoarsestUnit.
double unitForMetres(double farthest);

// `value` in units, rounded; 0 for what is no positive finite number. What is
// too far for 16 bits becomes 0 and is counted in `beyond`.
uint16_t unitsOf(double value, double valuesPerUnit, uint64_t& beyond);

} // namespace fathom
