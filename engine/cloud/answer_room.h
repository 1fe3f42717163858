// SPDX-License-Identifier: Apache-2.0
// Sizes of the buffers into which the device writes answers of unknown length.
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>

namespace fathom::cloud {

// Capacity for this many elements: a power of two, or UINT32_MAX where none is large enough.
inline uint32_t roomFor(uint32_t count) {
    return count > 0x80000000u ? UINT32_MAX : std::bit_ceil(count);
}

// Number of elements that are copied to the host before their number is known: a quarter more than last time.
inline uint32_t copiedAhead(uint32_t last, uint32_t least, uint32_t capacity) {
    return std::min(capacity, std::max(least, last + last / 4));
}

} // namespace fathom::cloud
