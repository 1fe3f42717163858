// SPDX-License-Identifier: Apache-2.0
// Formatted text of messages, files and labels.
#pragma once

#include <cstdio>
#include <string>

namespace fathom {

// Like std::snprintf, of any length.
template <class... Values>
std::string printed(const char* form, Values... values) {
    std::string text(static_cast<size_t>(std::snprintf(nullptr, 0, form, values...)), '\0');
    std::snprintf(text.data(), text.size() + 1, form, values...);
    return text;
}

} // namespace fathom
