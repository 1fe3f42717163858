// SPDX-License-Identifier: Apache-2.0
// The two ways in which a bag packs its chunks.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace fathom {

// compression: none, bz2 or lz4 (LZ4 frames, as roslz4 writes). size: of the unpacked chunk [bytes]. Throws
// Error when it does not come out at that size.
std::vector<uint8_t> unpackChunk(const std::string& compression, std::span<const uint8_t> packed,
                                 uint32_t size);

} // namespace fathom
