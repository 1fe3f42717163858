// SPDX-License-Identifier: Apache-2.0
// Short formatted text.
#pragma once

#include <cstdio>
#include <string>

namespace fathom::operate {

// Like std::snprintf; at most 159 bytes.
template <class... Values>
std::string printed(const char* form, Values... values) {
    char text[160];
    std::snprintf(text, sizeof text, form, values...);
    return text;
}

} // namespace fathom::operate
