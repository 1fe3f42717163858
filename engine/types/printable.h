// SPDX-License-Identifier: Apache-2.0
// Text from files, made safe to print.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace fathom {

// A character of UTF-8: its code point and its bytes. `bytes` is 1 and `valid` false for a byte that begins
// no character.
struct Utf8 {
    uint32_t code = 0;
    size_t bytes = 1;
    bool valid = false;
};

// The character at the start of `text`, which must not be empty.
inline Utf8 firstCharacter(std::string_view text) {
    const auto byte = [&](size_t i) { return static_cast<uint8_t>(text[i]); };
    const uint8_t lead = byte(0);
    if (lead < 0x80) {
        return {lead, 1, true};
    }
    const size_t bytes = lead >= 0xf0 ? 4 : lead >= 0xe0 ? 3 : 2;
    if (lead < 0xc2 || lead > 0xf4 || text.size() < bytes) {
        return {};
    }
    uint32_t code = lead & (0x7fu >> bytes);
    for (size_t i = 1; i < bytes; ++i) {
        if ((byte(i) & 0xc0) != 0x80) {
            return {};
        }
        code = code << 6 | (byte(i) & 0x3fu);
    }
    constexpr uint32_t kMin[] = {0, 0, 0x80, 0x800, 0x10000};
    const bool valid = code >= kMin[bytes] && code <= 0x10ffff && (code < 0xd800 || code > 0xdfff);
    return valid ? Utf8{code, bytes, true} : Utf8{};
}

// True for characters that end a line, control a terminal, or hide or reorder the text around them.
inline bool isControl(uint32_t code) {
    const auto in = [code](uint32_t lo, uint32_t hi) { return code >= lo && code <= hi; };
    return code < 0x20 || in(0x7f, 0x9f) || code == 0xad || code == 0x61c || in(0x200b, 0x200f) ||
           in(0x2028, 0x202e) || in(0x2060, 0x206f) || code == 0xfeff || in(0xfff9, 0xfffb) ||
           in(0xe0000, 0xe0fff);
}

// Replaces control characters by spaces and bytes that are not UTF-8 by '?', so that a message stays on one
// line, says what it shows and cannot control a terminal.
inline std::string printable(std::string_view text) {
    std::string out;
    for (size_t i = 0; i < text.size();) {
        const Utf8 c = firstCharacter(text.substr(i));
        if (c.valid && !isControl(c.code)) {
            out += text.substr(i, c.bytes);
        } else {
            out += c.valid ? ' ' : '?';
        }
        i += c.bytes;
    }
    return out;
}

// The first `most` bytes, with dots if there are more. For quoting untrusted input, which may be a whole
// file.
inline std::string excerpt(std::string text, size_t most = 80) {
    if (text.size() > most) {
        text.resize(most);
        text += "...";
    }
    return text;
}

} // namespace fathom
