// SPDX-License-Identifier: Apache-2.0
#include "engine/contact/cell_sort.h"

#include "engine/types/thread_pool.h"

#include <algorithm>
#include <doctest/doctest.h>
#include <numeric>
#include <random>

using namespace fathom;

namespace {

std::vector<uint32_t> cellsOf(size_t things, uint32_t cells, std::mt19937& random) {
    std::vector<uint32_t> cell(things);
    uint32_t at = 0;
    for (uint32_t& c : cell) { // mostly neighbouring cells, as from patches, with jumps
        const auto drawn = static_cast<uint32_t>(random());
        at = drawn % 50 == 0 ? drawn / 50 % cells : (at + drawn % 3) % cells;
        c = at;
    }
    return cell;
}

void check(CellSort& sort, const std::vector<uint32_t>& cell, uint32_t cells, ThreadPool* workers) {
    std::vector<uint32_t> begins(size_t{cells} + 1, 77), order(cell.size(), 77), expected(cell.size());
    sort.sort(
        cell, cells, begins, [&](uint32_t thing, uint32_t place) { order[place] = thing; }, workers);
    std::iota(expected.begin(), expected.end(), 0u);
    std::ranges::stable_sort(expected, {}, [&](uint32_t i) { return cell[i]; });
    CHECK(order == expected);
    std::vector<uint32_t> counts(size_t{cells} + 1, 0);
    for (const uint32_t c : cell) {
        ++counts[c + 1];
    }
    std::partial_sum(counts.begin(), counts.end(), counts.begin());
    CHECK(begins == counts);
}

} // namespace

TEST_CASE("Items are sorted stably by cell, with one thread or several, with few cells or many") {
    std::mt19937 random(5);
    ThreadPool workers(3);
    CellSort sort; // reused: earlier contents do not matter
    for (const size_t things : {0, 1, 31, 4095, 8192, 12289, 60'000}) {
        for (const uint32_t cells : {1u, 2u, 511u, 513u, 40'000u, 1u << 20}) {
            CAPTURE(things);
            CAPTURE(cells);
            const std::vector<uint32_t> cell = cellsOf(things, cells, random);
            check(sort, cell, cells, nullptr);
            check(sort, cell, cells, &workers);
        }
    }
}

TEST_CASE("Items that are all in the first or the last cell keep their order") {
    ThreadPool workers(2);
    CellSort sort;
    for (const uint32_t cells : {10'000u, 40'000u}) { // fewer than items (parts) and more (buckets)
        for (const uint32_t cell : {0u, cells - 1}) {
            CAPTURE(cells);
            check(sort, std::vector<uint32_t>(20'000, cell), cells, &workers);
        }
    }
}
