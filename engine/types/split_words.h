// SPDX-License-Identifier: Apache-2.0
// Words of a line of text.
#pragma once

#include <algorithm>
#include <string_view>
#include <vector>

namespace fathom {

// Splits at spaces, tabs and carriage returns. The words point into the line.
inline std::vector<std::string_view> splitWords(std::string_view line) {
    constexpr std::string_view kSpace = " \t\r";
    std::vector<std::string_view> words;
    for (size_t begin = line.find_first_not_of(kSpace); begin != std::string_view::npos;) {
        const size_t end = std::min(line.find_first_of(kSpace, begin), line.size());
        words.push_back(line.substr(begin, end - begin));
        begin = line.find_first_not_of(kSpace, end);
    }
    return words;
}

} // namespace fathom
