// SPDX-License-Identifier: Apache-2.0
// A stable radix sort of indices by source: of the spheres that they index.
#pragma once

#include <cstdint>
#include <vector>

namespace fathom {

// Memory that is kept between sorts. One thread.
struct SourceSort {
    std::vector<uint32_t> keys; // the source of each index; also sorted
    std::vector<uint32_t> sortedKeys, sorted;
};

// Sorts `indices` by sort.keys, which has as many; equal sources keep their order.
void sortBySource(std::vector<uint32_t>& indices, SourceSort& sort);

} // namespace fathom
