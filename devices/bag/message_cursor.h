// SPDX-License-Identifier: Apache-2.0
// Reads the values of one serialised message in sequence: ROS 1 (packed) or CDR of ROS 2 (aligned).
#pragma once

#include "devices/bag/byte_cursor.h"
#include "devices/bag/message_bytes.h"

#include <algorithm>

namespace fathom {

// Every call throws Error when too few bytes are left. Little-endian only.
class MessageCursor {
public:
    // cdr: the bytes begin with the encapsulation header of 4 bytes, from whose end values are aligned.
    MessageCursor(std::span<const uint8_t> bytes, bool cdr)
        : rest_(bytes)
        , cdr_(cdr) {
        if (!cdr) {
            return;
        }
        const auto head = rest_.take(4);
        if (head[0] != 0 || (head[1] != 1 && head[1] != 7)) {
            throw Error("CDR of kind " + std::to_string(head[0] << 8 | head[1]) +
                        " (allowed: plain little-endian)");
        }
        largest_ = head[1] == 7 ? 4 : 8;
        begin_ = rest_.left();
    }
    MessageCursor(const MessageBytes& bytes, bool cdr)
        : MessageCursor(bytes.view, cdr) {
        memory_ = bytes.memory;
    }

    template <class T>
    T value() {
        align(sizeof(T));
        return rest_.value<T>();
    }
    uint32_t word() { return value<uint32_t>(); }
    double real() { return value<double>(); }
    // A count of bytes, then the bytes.
    std::span<const uint8_t> block() { return rest_.take(word()); }
    // Control characters become spaces, so that quoted names stay on one line.
    std::string name() {
        auto bytes = block();
        if (cdr_ && !bytes.empty() && bytes.back() == 0) { // CDR counts the terminator
            bytes = bytes.first(bytes.size() - 1);
        }
        return printable({reinterpret_cast<const char*>(bytes.data()), bytes.size()});
    }
    bool cdr() const { return cdr_; }
    // Keeps the message's bytes; null where the caller of the constructor does.
    const std::shared_ptr<const void>& memory() const { return memory_; }
    size_t left() const { return rest_.left(); }

private:
    void align(size_t size) {
        const size_t to = std::min(size, largest_);
        if (cdr_ && (begin_ - rest_.left()) % to != 0) {
            rest_.take(to - (begin_ - rest_.left()) % to);
        }
    }

    ByteCursor rest_;
    std::shared_ptr<const void> memory_;
    bool cdr_;
    size_t largest_ = 8, begin_ = 0;
};

} // namespace fathom
