// SPDX-License-Identifier: Apache-2.0
// Reads little-endian values in sequence, with bounds checks.
#pragma once

#include "engine/types/error.h"
#include "engine/types/printable.h"

#include <cstdint>
#include <cstring>
#include <span>
#include <string>

namespace fathom {

// Every call throws Error "truncated" when too few bytes are left.
class ByteCursor {
public:
    explicit ByteCursor(std::span<const uint8_t> bytes)
        : rest_(bytes) {}

    // Reads the next bytes in host order (little-endian) and advances.
    std::span<const uint8_t> take(size_t count) {
        if (count > rest_.size()) {
            throw Error("truncated");
        }
        const auto taken = rest_.first(count);
        rest_ = rest_.subspan(count);
        return taken;
    }
    template <class T>
    T value() {
        T out;
        std::memcpy(&out, take(sizeof(T)).data(), sizeof(T));
        return out;
    }
    uint32_t word() { return value<uint32_t>(); }
    double real() { return value<double>(); }
    // A count of bytes, then the bytes.
    std::span<const uint8_t> block() { return take(word()); }
    std::string text() {
        const auto bytes = block();
        return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
    }
    // The same, with control characters replaced by spaces, so that quoted names stay on one line.
    std::string name() { return printable(text()); }
    bool empty() const { return rest_.empty(); }
    size_t left() const { return rest_.size(); }

private:
    std::span<const uint8_t> rest_;
};

} // namespace fathom
