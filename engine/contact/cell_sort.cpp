// SPDX-License-Identifier: Apache-2.0
#include "engine/contact/cell_sort.h"

#include "engine/types/crew.h"

#include <algorithm>
#include <utility>

namespace fathom {

namespace {

constexpr size_t kLeastPart = 4096;     // things
constexpr size_t kLeastBuckets = 16;    // of a part
constexpr size_t kThingsPerBucket = 32; // about, where the cells allow it
constexpr size_t kMostBuckets = 512;    // whose counts one thread sums up

// Things `begin` to `end`, at(i) the cell of the i-th, thing(i) its number, to begins of the cells from
// `from` up to `to`, and to order.
template <class Cell, class Thing>
void sortByCell(uint32_t begin, uint32_t end, const Cell& at, const Thing& thing, uint32_t from, uint32_t to,
                uint32_t* begins, uint32_t* order) noexcept {
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
    for (uint32_t i = end; i-- > begin;) { // backwards: keeps the order within a cell
        order[--begins[at(i)]] = thing(i);
    }
}

} // namespace

void CellSort::sort(std::span<const uint32_t> cell, uint32_t cells, std::span<uint32_t> begins,
                    std::span<uint32_t> order, Crew* crew) {
    const size_t members = crew == nullptr ? 1 : crew->members();
    const auto parts = static_cast<uint32_t>(std::clamp<size_t>(cell.size() / kLeastPart, 1, members));
    begins[cells] = static_cast<uint32_t>(cell.size());
    if (parts < 2) {
        const auto at = [cells = cell.data()](uint32_t i) { return cells[i]; };
        sortByCell(
            0, begins[cells], at, [](uint32_t i) { return i; }, 0, cells, begins.data(), order.data());
        return;
    }
    chooseBuckets(cell.size(), cells);
    toBuckets(cell, parts, *crew);
    inParts(crew, buckets_, kLeastBuckets, [&](size_t begin, size_t end) {
        for (size_t bucket = begin; bucket < end; ++bucket) {
            sortBucket(static_cast<uint32_t>(bucket), begins.first(cells), order);
        }
    });
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
    countsToPlaces(parts);
    inEachPart([&](uint32_t& next, size_t i) { placed[next++] = {cell[i], static_cast<uint32_t>(i)}; });
}

void CellSort::countsToPlaces(uint32_t parts) {
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

void CellSort::sortBucket(uint32_t bucket, std::span<uint32_t> begins,
                          std::span<uint32_t> order) const noexcept {
    const auto cells = static_cast<uint32_t>(begins.size());
    const auto at = [placed = placed_.data()](uint32_t i) { return placed[i].cell; };
    const auto thing = [placed = placed_.data()](uint32_t i) { return placed[i].thing; };
    sortByCell(first_[bucket], first_[bucket + 1], at, thing, bucket << shift_,
               std::min(cells, (bucket + 1) << shift_), begins.data(), order.data());
}

} // namespace fathom
