// SPDX-License-Identifier: Apache-2.0
// Appends little-endian values to bytes; CDR of ROS 2 on top of it.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

namespace fathom {

// Values without padding.
class ByteWriter {
public:
    template <class T>
    void value(T number) {
        append({reinterpret_cast<const uint8_t*>(&number), sizeof number}); // host order is little-endian
    }
    void append(std::span<const uint8_t> bytes) {
        const size_t before = bytes_.size();
        bytes_.resize(before + bytes.size()); // GCC 12 and 14 warn about insert()
        std::copy(bytes.begin(), bytes.end(), bytes_.begin() + static_cast<std::ptrdiff_t>(before));
    }
    // A count of bytes (32 bits), then the bytes.
    void text(std::string_view text) {
        value(static_cast<uint32_t>(text.size()));
        append({reinterpret_cast<const uint8_t*>(text.data()), text.size()});
    }
    const std::vector<uint8_t>& bytes() const { return bytes_; }
    size_t size() const { return bytes_.size(); }
    void clear() { bytes_.clear(); }

private:
    std::vector<uint8_t> bytes_;
};

// One message in CDR, little-endian: values are aligned to their size, counted from the end of the header.
class CdrWriter {
public:
    CdrWriter() { out_.append(kPlainCdr); }

    template <class T>
    void value(T number) {
        while ((out_.size() - kPlainCdr.size()) % sizeof number != 0) {
            out_.value(uint8_t{0});
        }
        out_.value(number);
    }
    template <class T>
    void values(std::span<const T> numbers) {
        for (const T number : numbers) {
            value(number);
        }
    }
    void text(std::string_view text) {
        value(static_cast<uint32_t>(text.size() + 1));
        out_.append({reinterpret_cast<const uint8_t*>(text.data()), text.size()});
        out_.value(uint8_t{0});
    }
    // A sequence of bytes.
    void block(std::span<const uint8_t> bytes) {
        value(static_cast<uint32_t>(bytes.size()));
        out_.append(bytes);
    }
    const std::vector<uint8_t>& bytes() const { return out_.bytes(); }

private:
    static constexpr std::array<uint8_t, 4> kPlainCdr{0, 1, 0, 0};
    ByteWriter out_;
};

} // namespace fathom
