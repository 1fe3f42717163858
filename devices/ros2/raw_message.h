// SPDX-License-Identifier: Apache-2.0
// One serialised message as DDS carries it.
#pragma once

#include <cstdint>
#include <memory>
#include <span>

namespace fathom {

// Largest message that is received [bytes]: a colour image of 3840x2160 pixels with 4 x 16 bits.
inline constexpr uint32_t kMaxMessage = 80u << 20;

// CDR with its header of 4 bytes, which says how the rest is encoded.
struct RawMessage {
    std::unique_ptr<uint8_t[]> memory; // padded with zeros to a multiple of 4
    uint32_t size = 0;                 // without the padding
    double arrival = 0.0;              // [s] CLOCK_MONOTONIC
    double arrivalUtc = 0.0;           // [s] CLOCK_REALTIME at the same moment

    std::span<const uint8_t> bytes() const { return {memory.get(), size}; }
};
// Shared by the inbox and the readers.
using RawMessagePtr = std::shared_ptr<const RawMessage>;

} // namespace fathom
