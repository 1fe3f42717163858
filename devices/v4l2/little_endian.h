// SPDX-License-Identifier: Apache-2.0
// Numbers in the bytes of a camera.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace fathom {

// 32 bits, the lowest byte first.
inline uint32_t littleEndianWord(std::span<const uint8_t> bytes, size_t at) {
    return bytes[at] | bytes[at + 1] << 8 | bytes[at + 2] << 16 | static_cast<uint32_t>(bytes[at + 3]) << 24;
}

} // namespace fathom
