// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <string>

namespace fathom {

// With a space for each control character: whatever a message quotes, it stays one line and tells a terminal
// nothing.
inline std::string printable(std::string text) {
    std::replace_if(
        text.begin(), text.end(), [](unsigned char c) { return c < 0x20 || c == 0x7f; }, ' ');
    return text;
}

// The first `most` bytes, with dots where there are more: what a message quotes of strangers may be a whole
// file.
inline std::string excerpt(std::string text, size_t most = 80) {
    if (text.size() > most) {
        text.resize(most);
        text += "...";
    }
    return text;
}

} // namespace fathom
