// SPDX-License-Identifier: Apache-2.0
#include "engine/contact/source_sort.h"

#include <algorithm>
#include <array>
#include <bit>
#include <numeric>
#include <span>

namespace fathom {

void sortBySource(std::vector<uint32_t>& indices, SourceSort& sort) {
    if (std::is_sorted(sort.keys.begin(), sort.keys.end())) {
        return;
    }
    const size_t count = indices.size();
    sort.sortedKeys.resize(count);
    sort.sorted.resize(count);
    // As few passes as digits of 11 bits need. The keys of one tool's spheres differ by few bits.
    uint32_t first = UINT32_MAX, last = 0;
    for (const uint32_t key : sort.keys) {
        first = std::min(first, key);
        last = std::max(last, key);
    }
    const uint32_t width = std::bit_width(last - first), passes = (width + 10) / 11,
                   bits = (width + passes - 1) / passes;
    std::array<uint32_t, (1u << 11)> digits;
    const std::span begin(digits.data(), size_t{1} << bits);
    for (uint32_t shift = 0; shift < width; shift += bits) {
        const auto digit = [&](size_t i) { return ((sort.keys[i] - first) >> shift) & (begin.size() - 1); };
        std::ranges::fill(begin, 0u);
        for (size_t i = 0; i < count; ++i) {
            ++begin[digit(i)];
        }
        std::exclusive_scan(begin.begin(), begin.end(), begin.begin(), 0u);
        for (size_t i = 0; i < count; ++i) {
            const uint32_t to = begin[digit(i)]++;
            sort.sorted[to] = indices[i];
            sort.sortedKeys[to] = sort.keys[i];
        }
        indices.swap(sort.sorted);
        sort.keys.swap(sort.sortedKeys);
    }
}

} // namespace fathom
