// SPDX-License-Identifier: Apache-2.0
// Lists in messages.
#pragma once

#include <functional>
#include <string>
#include <string_view>

namespace fathom {

// text(x) of every element of `list`, separated by `between`. text: a member or a function; by default the
// element itself.
template <class List, class Text = std::identity>
std::string joined(const List& list, Text text = {}, std::string_view between = ", ") {
    std::string all;
    for (const auto& element : list) {
        all += all.empty() ? "" : between;
        all += std::invoke(text, element);
    }
    return all;
}

} // namespace fathom
