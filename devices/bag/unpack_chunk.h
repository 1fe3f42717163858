// SPDX-License-Identifier: Apache-2.0
// Decompression of the chunks of bags and MCAP files, and of messages that are compressed one by one.
#pragma once

#include "devices/bag/message_bytes.h"

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace fathom {

// compression: none, bz2, lz4 (LZ4 frames, as roslz4 and MCAP write) or zstd. size: of the unpacked chunk
// [bytes]. Throws Error when the result has another size.
std::vector<uint8_t> unpackChunk(const std::string& compression, std::span<const uint8_t> packed,
                                 uint32_t size);

// A message that rosbag2 stored as a zstd frame (compression_mode: message), unpacked; another one unchanged.
// Throws Error when the frame does not state its size, or more than 256 MiB.
MessageBytes unpackMessage(MessageBytes message);

} // namespace fathom
