// SPDX-License-Identifier: Apache-2.0
// Stable parallel counting sort by cell. It computes the place of each item, and the caller's function moves
// the item there. Each thread counts and moves a part of the items. With more cells than items, the items
// first go into buckets of neighbouring cells, and free threads take buckets to sort.
#pragma once

#include "engine/types/thread_pool.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace fathom {

class CellSort {
public:
    // cell: cell of each item, below `cells`. begins (cells + 1): place of each cell's first item, then the
    // number of items. put(item, place), noexcept, is called once per item, from any thread and in any order.
    // Places are ordered by cell, then by index. Results do not depend on the thread pool; null = the calling
    // thread only. Allocates only when sizes exceed all earlier ones: up to 4 bytes per cell and thread, and
    // 8 per item.
    template <class Put>
    void sort(std::span<const uint32_t> cell, uint32_t cells, std::span<uint32_t> begins, const Put& put,
              ThreadPool* workers);

private:
    static constexpr size_t kMinPart = 2048;  // items
    static constexpr size_t kMinBuckets = 16; // per part
    static constexpr size_t kBlock = 256;     // cells whose counts are cleared and summed together

    struct Placed {
        uint32_t cell, item;
    };
    // Sorts items `begin` to `end`, at(i) = cell of item i, into the cells `from` up to `to`. Afterwards the
    // cells' entries in begins hold the end of each cell.
    template <class Cell>
    static void countCells(uint32_t begin, uint32_t end, const Cell& at, uint32_t from, uint32_t to,
                           uint32_t* begins) noexcept;
    template <class Put>
    void sortParts(std::span<const uint32_t> cell, std::span<uint32_t> begins, const Put& put, uint32_t parts,
                   ThreadPool& workers);
    template <class Put>
    void sortBucket(uint32_t bucket, std::span<uint32_t> begins, const Put& put) const noexcept;

    static size_t blocksOf(size_t cells) noexcept { return (cells + kBlock - 1) / kBlock; }
    void countParts(std::span<const uint32_t> cell, size_t cells, uint32_t parts, ThreadPool& workers);
    void placesOfParts(std::span<uint32_t> begins, uint32_t parts, ThreadPool& workers);
    void placesInBlock(size_t block, std::span<uint32_t> begins, uint32_t parts) noexcept;
    void chooseBuckets(size_t items, uint32_t cells);
    void toBuckets(std::span<const uint32_t> cell, uint32_t parts, ThreadPool& workers);
    void placesOfBuckets(uint32_t parts);

    uint32_t shift_ = 0, buckets_ = 0; // bucket = cell >> shift
    std::vector<uint32_t> next_;       // per part of the items and per cell or bucket: place of its next item
    std::vector<uint32_t> first_;      // buckets + 1, or blocks of cells: place of the first item
    std::vector<uint32_t> inBlock_;    // per part: items in each block
    std::vector<Placed> placed_;       // by bucket
};

template <class Put>
void CellSort::sort(std::span<const uint32_t> cell, uint32_t cells, std::span<uint32_t> begins,
                    const Put& put, ThreadPool* workers) {
    const auto items = static_cast<uint32_t>(cell.size());
    const size_t threads = workers == nullptr ? 1 : workers->size();
    const auto parts = static_cast<uint32_t>(std::clamp<size_t>(items / kMinPart, 1, threads));
    begins[cells] = items;
    if (parts < 2) {
        countCells(
            0, items, [&](uint32_t i) { return cell[i]; }, 0, cells, begins.data());
        for (uint32_t i = items; i-- > 0;) { // backwards, which keeps the order within a cell
            put(i, --begins[cell[i]]);
        }
    } else if (cells <= items) {
        sortParts(cell, begins.first(cells), put, parts, *workers);
    } else {
        chooseBuckets(items, cells);
        toBuckets(cell, parts, *workers);
        inParts(workers, buckets_, kMinBuckets, [&](size_t begin, size_t end) {
            for (size_t bucket = begin; bucket < end; ++bucket) {
                sortBucket(static_cast<uint32_t>(bucket), begins.first(cells), put);
            }
        });
    }
}

template <class Cell>
void CellSort::countCells(uint32_t begin, uint32_t end, const Cell& at, uint32_t from, uint32_t to,
                          uint32_t* begins) noexcept {
    std::fill(begins + from, begins + to, begin == end ? begin : 0);
    if (begin == end) {
        return;
    }
    for (uint32_t i = begin; i < end; ++i) {
        ++begins[at(i)];
    }
    uint32_t sum = begin;
    for (uint32_t cell = from; cell < to; ++cell) {
        sum += begins[cell];
        begins[cell] = sum;
    }
}

template <class Put>
void CellSort::sortParts(std::span<const uint32_t> cell, std::span<uint32_t> begins, const Put& put,
                         uint32_t parts, ThreadPool& workers) {
    countParts(cell, begins.size(), parts, workers);
    placesOfParts(begins, parts, workers);
    workers.run(parts, [&](uint32_t part) {
        uint32_t* const next = &next_[part * blocksOf(begins.size()) * kBlock];
        const size_t from = cell.size() * part / parts, to = cell.size() * (part + 1) / parts;
        for (size_t i = from; i < to; ++i) {
            put(static_cast<uint32_t>(i), next[cell[i]]++);
        }
    });
}

template <class Put>
void CellSort::sortBucket(uint32_t bucket, std::span<uint32_t> begins, const Put& put) const noexcept {
    const auto cells = static_cast<uint32_t>(begins.size());
    const Placed* const placed = placed_.data();
    const uint32_t begin = first_[bucket], end = first_[bucket + 1];
    countCells(
        begin, end, [&](uint32_t i) { return placed[i].cell; }, bucket << shift_,
        std::min(cells, (bucket + 1) << shift_), begins.data());
    for (uint32_t i = end; i-- > begin;) {
        put(placed[i].item, --begins[placed[i].cell]);
    }
}

} // namespace fathom
