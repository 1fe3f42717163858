// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <string>

namespace fathom {

// Replaces control characters by spaces, so that a message stays on one line and cannot control a terminal.
inline std::string printable(std::string text) {
    std::replace_if(
        text.begin(), text.end(), [](unsigned char c) { return c < 0x20 || c == 0x7f; }, ' ');
    return text;
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
