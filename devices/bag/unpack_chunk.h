// SPDX-License-Identifier: Apache-2.0
// Decompression of the chunks of bags and MCAP files, and of messages of ROS 2 databases.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace fathom {

// compression: none, bz2, lz4 (LZ4 frames, as roslz4 and MCAP write) or zstd. size: of the unpacked chunk
// [bytes]. Throws Error when the result has another size.
std::vector<uint8_t> unpackChunk(const std::string& compression, std::span<const uint8_t> packed,
                                 uint32_t size);

// Whether the bytes begin as a zstd frame.
bool isZstd(std::span<const uint8_t> bytes);
// A zstd frame that states its size, at most `most` [bytes]. Throws Error.
std::vector<uint8_t> unpackZstdFrame(std::span<const uint8_t> packed, uint64_t most);

} // namespace fathom
