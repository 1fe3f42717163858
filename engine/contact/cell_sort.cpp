// SPDX-License-Identifier: Apache-2.0
#include "engine/contact/cell_sort.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <utility>

namespace fathom {

namespace {

constexpr size_t kItemsPerBucket = 32; // approximate
constexpr size_t kMaxBuckets = 512;    // one thread sums their counts
constexpr size_t kMinBlocks = 8;       // one thread computes their places

} // namespace

// Counts items per cell and per block of cells, for each part. Neighbouring items are mostly in neighbouring
// cells, so a part has items in few blocks. Counts of other blocks are neither cleared nor read.
void CellSort::countParts(std::span<const uint32_t> cell, size_t cells, uint32_t parts, ThreadPool& workers) {
    const size_t blocks = blocksOf(cells);
    if (next_.size() < parts * blocks * kBlock) {
        next_.resize(parts * blocks * kBlock);
    }
    inBlock_.assign(parts * blocks, 0);
    workers.run(parts, [&](uint32_t part) {
        uint32_t* const counts = &next_[part * blocks * kBlock];
        uint32_t* const inBlock = &inBlock_[part * blocks];
        const size_t from = cell.size() * part / parts, to = cell.size() * (part + 1) / parts;
        for (size_t i = from; i < to; ++i) {
            const uint32_t block = cell[i] / kBlock;
            if (inBlock[block] == 0) {
                inBlock[block] = 1; // not empty; the number is summed below
                std::fill_n(counts + block * kBlock, kBlock, 0);
            }
            ++counts[cell[i]];
        }
        for (size_t block = 0; block < blocks; ++block) {
            const uint32_t* const here = counts + block * kBlock;
            inBlock[block] = inBlock[block] == 0 ? 0 : std::accumulate(here, here + kBlock, 0u);
        }
    });
}

// Turns the counts into the place of each part's first item in each cell: after all earlier cells and after
// the earlier parts in this cell.
void CellSort::placesOfParts(std::span<uint32_t> begins, uint32_t parts, ThreadPool& workers) {
    const size_t blocks = blocksOf(begins.size());
    first_.resize(blocks);
    uint32_t sum = 0;
    for (size_t block = 0; block < blocks; ++block) {
        first_[block] = sum;
        for (uint32_t part = 0; part < parts; ++part) {
            sum += inBlock_[part * blocks + block];
        }
    }
    inParts(&workers, blocks, kMinBlocks, [&](size_t begin, size_t end) {
        for (size_t block = begin; block < end; ++block) {
            placesInBlock(block, begins, parts);
        }
    });
}

void CellSort::placesInBlock(size_t block, std::span<uint32_t> begins, uint32_t parts) noexcept {
    const size_t blocks = blocksOf(begins.size()), cells = std::min(begins.size() - block * kBlock, kBlock);
    std::array<uint32_t, kBlock> here{}; // items per cell in the parts so far
    uint32_t* const next = &next_[block * kBlock];
    for (uint32_t part = 0; part < parts; ++part) {
        if (inBlock_[part * blocks + block] != 0) {
            uint32_t* const counts = next + part * blocks * kBlock;
            for (size_t c = 0; c < kBlock; ++c) {
                here[c] += std::exchange(counts[c], here[c]);
            }
        }
    }
    uint32_t sum = first_[block];
    for (size_t c = 0; c < kBlock; ++c) {
        sum += std::exchange(here[c], sum);
    }
    std::copy_n(here.begin(), cells, &begins[block * kBlock]);
    for (uint32_t part = 0; part < parts; ++part) {
        if (inBlock_[part * blocks + block] != 0) {
            uint32_t* const counts = next + part * blocks * kBlock;
            for (size_t c = 0; c < kBlock; ++c) {
                counts[c] += here[c];
            }
        }
    }
}

void CellSort::chooseBuckets(size_t items, uint32_t cells) {
    const size_t most = std::clamp<size_t>(items / kItemsPerBucket, 1, kMaxBuckets);
    for (shift_ = 0; (cells - 1) >> shift_ >= most;) {
        ++shift_;
    }
    buckets_ = ((cells - 1) >> shift_) + 1;
}

// Each part counts its items; all counts together give the place of its first item in each bucket.
void CellSort::toBuckets(std::span<const uint32_t> cell, uint32_t parts, ThreadPool& workers) {
    next_.assign(size_t{parts} * buckets_, 0);
    placed_.resize(cell.size());
    Placed* const placed = placed_.data();
    const auto inEachPart = [&](auto&& each) {
        workers.run(parts, [&](uint32_t part) {
            uint32_t* const next = &next_[size_t{part} * buckets_];
            const uint32_t shift = shift_;
            const size_t from = cell.size() * part / parts, to = cell.size() * (part + 1) / parts;
            for (size_t i = from; i < to; ++i) {
                each(next[cell[i] >> shift], i);
            }
        });
    };
    inEachPart([](uint32_t& count, size_t) { ++count; });
    placesOfBuckets(parts);
    inEachPart([&](uint32_t& next, size_t i) { placed[next++] = {cell[i], static_cast<uint32_t>(i)}; });
}

void CellSort::placesOfBuckets(uint32_t parts) {
    first_.resize(size_t{buckets_} + 1);
    uint32_t sum = 0;
    for (uint32_t bucket = 0; bucket < buckets_; ++bucket) {
        first_[bucket] = sum;
        for (uint32_t part = 0; part < parts; ++part) {
            sum += std::exchange(next_[size_t{part} * buckets_ + bucket], sum);
        }
    }
    first_.back() = sum;
}

} // namespace fathom
