// SPDX-License-Identifier: Apache-2.0
#include "engine/types/suggestion.h"

#include <algorithm>
#include <iterator>
#include <vector>

namespace fathom {

namespace {

// Optimal string alignment distance: one typing error (insertion, deletion, substitution or swap) costs 1.
size_t editDistance(std::string_view a, std::string_view b) {
    const size_t width = b.size() + 1;
    std::vector<size_t> d((a.size() + 1) * width);
    for (size_t i = 0; i <= a.size(); ++i) {
        for (size_t j = 0; j <= b.size(); ++j) {
            size_t& cost = d[i * width + j];
            if (i == 0 || j == 0) {
                cost = i + j;
                continue;
            }
            cost = std::min({d[(i - 1) * width + j] + 1, d[i * width + j - 1] + 1,
                             d[(i - 1) * width + j - 1] + (a[i - 1] != b[j - 1] ? 1u : 0u)});
            if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1]) {
                cost = std::min(cost, d[(i - 2) * width + j - 2] + 1);
            }
        }
    }
    return d.back();
}

} // namespace

std::string_view nearestWord(std::string_view word, std::span<const std::string_view> words) {
    const std::string_view start =
        word.substr(0, 64); // long enough for every key; bounds the work on garbage
    std::string_view nearest;
    size_t least = start.size();
    for (const std::string_view known : words) {
        const size_t distance = editDistance(start, known);
        if (distance < least && 2 * distance < std::max(start.size(), known.size())) {
            least = distance;
            nearest = known;
        }
    }
    return nearest;
}

bool isMisspelt(std::string_view word, std::string_view known) {
    const auto digitsOf = [](std::string_view name) {
        std::string digits;
        std::ranges::copy_if(name, std::back_inserter(digits), [](char c) { return c >= '0' && c <= '9'; });
        return digits;
    };
    return !nearestWord(word, {&known, 1}).empty() && editDistance(word, known) <= 2 &&
           digitsOf(word) == digitsOf(known);
}

std::string suggestion(std::string_view word, std::span<const std::string_view> words) {
    const std::string_view nearest = nearestWord(word, words);
    return nearest.empty() ? "" : ", did you mean '" + std::string(nearest) + "'?";
}

} // namespace fathom
