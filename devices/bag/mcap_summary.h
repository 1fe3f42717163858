// SPDX-License-Identifier: Apache-2.0
// The summary at the end of an MCAP file. Source: mcap.dev/spec.
#pragma once

#include "devices/bag/file_bytes.h"

#include <optional>

namespace fathom {

// What a summary says about a file whose messages are all in chunks.
struct McapSummary {
    struct Chunk {                               // its place in the file
        uint64_t at = 0, size = 0;               // of the chunk's content [bytes]
        uint64_t indexesAt = 0, indexesSize = 0; // of the message indexes after it
    };
    std::vector<std::vector<uint8_t>> schemas, channels; // contents of these records
    std::vector<Chunk> chunks;                           // in the order of the file, none overlaps another
    uint64_t messages = 0;                               // in the file
};

// Empty where there is no summary, or one that is damaged, incomplete or contradicts itself: such a file is
// to be read record by record.
std::optional<McapSummary> mcapSummary(FileBytes& file);

} // namespace fathom
