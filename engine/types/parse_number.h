// SPDX-License-Identifier: Apache-2.0
// A number from text, in any locale.
#pragma once

#include <charconv>
#include <string_view>
#include <system_error>

namespace fathom {

// False unless the whole text is one number of this type. Accepts no '+' and no blanks.
template <class T>
bool parseWhole(std::string_view text, T& value) noexcept {
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    return error == std::errc{} && end == text.data() + text.size();
}

} // namespace fathom
