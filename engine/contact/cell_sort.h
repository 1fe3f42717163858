// SPDX-License-Identifier: Apache-2.0
// Stable counting sort by cell. Shared by several threads it goes by two digits: things fall into buckets of
// neighbouring cells, and each bucket is sorted by whoever is free. One thread alone takes one digit, which
// is two thirds of the work.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace fathom {

class Crew;

class CellSort {
public:
    // cell: of each thing, below `cells`. begins (cells + 1): place of each cell's first thing, then their
    // number. order (as many as things): things by cell, within one by number. crew: who shares the work;
    // the result is the same whoever does; null: the caller alone. Allocates when there is more than ever
    // before.
    void sort(std::span<const uint32_t> cell, uint32_t cells, std::span<uint32_t> begins,
              std::span<uint32_t> order, Crew* crew);

private:
    struct Placed {
        uint32_t cell, thing;
    };
    void chooseBuckets(size_t things, uint32_t cells);
    void toBuckets(std::span<const uint32_t> cell, uint32_t parts, Crew& crew);
    void countsToPlaces(uint32_t parts);
    void sortBucket(uint32_t bucket, std::span<uint32_t> begins, std::span<uint32_t> order) const noexcept;

    uint32_t shift_ = 0, buckets_ = 0; // bucket = cell >> shift
    std::vector<uint32_t> next_;       // of each part of the things, a bucket each: where its next thing goes
    std::vector<uint32_t> first_;      // buckets + 1: place of each bucket's first thing
    std::vector<Placed> placed_;       // by bucket
};

} // namespace fathom
