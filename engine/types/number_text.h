// SPDX-License-Identifier: Apache-2.0
// Numbers and names in messages and files.
#pragma once

#include <concepts>
#include <cstdio>
#include <string>
#include <string_view>

namespace fathom {

// At most so many significant digits, 1 to 17, without trailing zeros.
inline std::string significant(double value, int digits) {
    char text[40];
    std::snprintf(text, sizeof text, "%.*g", digits, value);
    return text;
}

// "640x480"
inline std::string sizeText(std::integral auto width, std::integral auto height) {
    return std::to_string(width) + "x" + std::to_string(height);
}

// In double quotes, with escapes that YAML and JSON share.
inline std::string doubleQuoted(std::string_view text) {
    std::string out = "\"";
    for (const char c : text) {
        if (const auto byte = static_cast<unsigned char>(c); byte < 0x20) {
            char escape[8];
            std::snprintf(escape, sizeof escape, "\\u%04x", unsigned{byte});
            out += escape;
            continue;
        }
        out += c == '"' || c == '\\' ? "\\" : "";
        out += c;
    }
    return out + "\"";
}

} // namespace fathom
