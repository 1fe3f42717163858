// SPDX-License-Identifier: Apache-2.0
// Keeps the most recently used chunks of a file in memory, unpacked.
#pragma once

#include <algorithm>
#include <cstdint>
#include <memory>
#include <vector>

namespace fathom {

// Shared with its messages.
using UnpackedChunk = std::shared_ptr<const std::vector<uint8_t>>;

class UnpackedChunks {
public:
    // The chunk at this offset of the file; unpack() makes it where it is not cached.
    template <class Unpack>
    UnpackedChunk at(uint64_t chunk, Unpack unpack) {
        for (Entry& entry : entries_) {
            if (entry.chunk == chunk) {
                entry.used = ++clock_;
                return entry.bytes;
            }
        }
        Entry fresh{chunk, std::make_shared<const std::vector<uint8_t>>(unpack()), ++clock_};
        if (entries_.size() < kMax) {
            entries_.reserve(kMax);
            return entries_.emplace_back(std::move(fresh)).bytes;
        }
        auto oldest = std::ranges::min_element(entries_, {}, &Entry::used);
        *oldest = std::move(fresh);
        return oldest->bytes;
    }

private:
    static constexpr size_t kMax = 4; // depth, colour and the lenses of both
    struct Entry {
        uint64_t chunk = 0;
        UnpackedChunk bytes;
        uint64_t used = 0;
    };
    std::vector<Entry> entries_;
    uint64_t clock_ = 0;
};

} // namespace fathom
