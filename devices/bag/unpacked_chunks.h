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
    // The chunk at this offset of the file; unpack() makes it where it is not kept.
    template <class Unpack>
    UnpackedChunk at(uint64_t chunk, Unpack unpack) {
        for (Kept& kept : kept_) {
            if (kept.chunk == chunk) {
                kept.used = ++clock_;
                return kept.bytes;
            }
        }
        Kept fresh{chunk, std::make_shared<const std::vector<uint8_t>>(unpack()), ++clock_};
        if (kept_.size() < kMax) {
            kept_.reserve(kMax);
            return kept_.emplace_back(std::move(fresh)).bytes;
        }
        auto oldest = std::ranges::min_element(kept_, {}, &Kept::used);
        *oldest = std::move(fresh);
        return oldest->bytes;
    }

private:
    static constexpr size_t kMax = 4; // depth, colour and the lenses of both
    struct Kept {
        uint64_t chunk = 0;
        UnpackedChunk bytes;
        uint64_t used = 0;
    };
    std::vector<Kept> kept_;
    uint64_t clock_ = 0;
};

} // namespace fathom
