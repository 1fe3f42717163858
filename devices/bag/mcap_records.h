// SPDX-License-Identifier: Apache-2.0
// Kinds of records in an MCAP file, as its readers need them. Source: mcap.dev/spec.
#pragma once

#include <array>
#include <cstdint>

namespace fathom::mcap {

inline constexpr std::array<uint8_t, 8> kMagic{0x89, 'M', 'C', 'A', 'P', '0', '\r', '\n'};
inline constexpr uint8_t kFooter = 2, kSchema = 3, kChannel = 4, kMessage = 5, kChunk = 6, kMessageIndex = 7,
                         kChunkIndex = 8, kStatistics = 11;
inline constexpr uint64_t kRecordHead = 9; // kind and length [bytes]

} // namespace fathom::mcap
