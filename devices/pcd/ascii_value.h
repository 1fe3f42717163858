// SPDX-License-Identifier: Apache-2.0
// Values of ASCII point clouds.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

namespace fathom {

// Writes one value as in a binary file. type: F, U or I (others as I), size: 1 to 8 bytes, as PCD defines
// them. False when the whole word is not a number of that type.
bool putAsciiValue(const std::string& word, char type, size_t size, uint8_t* to);

} // namespace fathom
