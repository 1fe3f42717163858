// SPDX-License-Identifier: Apache-2.0
#include "engine/contact/cell_sort.h"

#include <algorithm>
#include <utility>

namespace fathom {

namespace {

constexpr size_t kThingsPerBucket = 32; // about, where the cells allow it
constexpr size_t kMostBuckets = 512;    // whose counts one thread sums up
constexpr size_t kLeastCells = 2048;    // whose counts one thread sums up

} // namespace

// Of each part, things in each cell.
void CellSort::countParts(std::span<const uint32_t> cell, std::span<uint32_t> begins, uint32_t parts,
                          Crew& crew) {
    const size_t cells = begins.size();
    if (next_.size() < parts * cells) {
        next_.resize(parts * cells);
    }
    crew.run(parts, [&](uint32_t part) {
        uint32_t* const counts = &next_[part * cells];
        std::fill_n(counts, cells, 0);
        const size_t from = cell.size() * part / parts, to = cell.size() * (part + 1) / parts;
        for (size_t i = from; i < to; ++i) {
            ++counts[cell[i]];
        }
    });
}

// From those counts each part knows where its first thing of each cell goes: behind those of all cells before
// and of the parts before in this one.
void CellSort::placesOfParts(std::span<uint32_t> begins, uint32_t parts, Crew& crew) {
    const size_t cells = begins.size(), runs = partsOf(&crew, cells, kLeastCells);
    const auto firstCell = [&](size_t run) { return cells * run / runs; };
    first_.assign(runs, 0);
    if (runs > 1) {
        crew.run(static_cast<uint32_t>(runs), [&](uint32_t run) {
            uint32_t sum = 0;
            for (uint32_t part = 0; part < parts; ++part) {
                const uint32_t* const counts = &next_[part * cells];
                for (size_t c = firstCell(run); c < firstCell(run + 1); ++c) {
                    sum += counts[c];
                }
            }
            first_[run] = sum;
        });
    }
    uint32_t before = 0;
    for (uint32_t& first : first_) {
        before += std::exchange(first, before);
    }
    const auto place = [&](uint32_t run) {
        uint32_t sum = first_[run];
        for (size_t c = firstCell(run); c < firstCell(run + 1); ++c) {
            begins[c] = sum;
            for (uint32_t part = 0; part < parts; ++part) {
                sum += std::exchange(next_[part * cells + c], sum);
            }
        }
    };
    if (runs == 1) { // nobody is called for it
        place(0);
        return;
    }
    crew.run(static_cast<uint32_t>(runs), place);
}

void CellSort::chooseBuckets(size_t things, uint32_t cells) {
    const size_t most = std::clamp<size_t>(things / kThingsPerBucket, 1, kMostBuckets);
    for (shift_ = 0; (cells - 1) >> shift_ >= most;) {
        ++shift_;
    }
    buckets_ = ((cells - 1) >> shift_) + 1;
}

// Each part counts its things, and knows from all counts where its first of each bucket goes.
void CellSort::toBuckets(std::span<const uint32_t> cell, uint32_t parts, Crew& crew) {
    next_.assign(size_t{parts} * buckets_, 0);
    placed_.resize(cell.size());
    Placed* const placed = placed_.data();
    const auto inEachPart = [&](auto&& each) {
        crew.run(parts, [&](uint32_t part) {
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
