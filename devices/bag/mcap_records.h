// SPDX-License-Identifier: Apache-2.0
// Kinds of records in an MCAP file, as its readers need them. Source: mcap.dev/spec.
#pragma once

#include <array>
#include <cstdint>

namespace fathom::mcap {

// The first and the last bytes of a file.
inline constexpr std::array<uint8_t, 8> kMagic{0x89, 'M', 'C', 'A', 'P', '0', '\r', '\n'};
// Kind of record: its first byte.
inline constexpr uint8_t kFooter = 2;
inline constexpr uint8_t kSchema = 3;
inline constexpr uint8_t kChannel = 4;
inline constexpr uint8_t kMessage = 5;
inline constexpr uint8_t kChunk = 6;
inline constexpr uint8_t kMessageIndex = 7;
inline constexpr uint8_t kChunkIndex = 8;
inline constexpr uint8_t kStatistics = 11;
inline constexpr uint64_t kRecordHeader = 9; // kind and length [bytes]

} // namespace fathom::mcap
