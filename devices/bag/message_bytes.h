// SPDX-License-Identifier: Apache-2.0
// The bytes of one serialised message, with the memory that holds them.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace fathom {

// Valid while it or a copy of it exists, whatever else is read from the file meanwhile.
struct MessageBytes {
    std::span<const uint8_t> view;
    std::shared_ptr<const void> memory; // of the view; null: memory that the file keeps until it is closed

    // All of these bytes.
    static MessageBytes of(std::vector<uint8_t> bytes) {
        const auto kept = std::make_shared<const std::vector<uint8_t>>(std::move(bytes));
        return {*kept, kept};
    }
};

} // namespace fathom
