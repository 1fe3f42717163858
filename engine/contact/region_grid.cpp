// SPDX-License-Identifier: Apache-2.0
#include "engine/contact/region_grid.h"

#include "engine/contact/clones.h"
#include "engine/types/thread_pool.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <limits>
#include <numeric>

namespace fathom {

namespace {

constexpr double kSmallestCell = 0.005;  // [m]
constexpr uint64_t kMaxCells = 4u << 20; // 16 MiB of cell starts
constexpr uint64_t kFewestCells = 4096;  // below this the cost of clearing is negligible
constexpr uint64_t kCellsPerSphere = 8;  // keeps clearing and summing cheaper than sorting the spheres
constexpr size_t kRun = 4096;            // spheres per batch: 16 KiB per column
constexpr size_t kBoundLanes = 8;        // lanes of running bounds and sums
constexpr size_t kBoundRows = 4; // rows of lanes, so that a comparison need not wait for the previous one
using Lanes = float __attribute__((vector_size(4 * kBoundLanes)));

int64_t cellsAlong(double extent, double size) {
    return static_cast<int64_t>(extent / size) + 1;
}

uint32_t isNotFinite(float v) { // infinite or not a number
    return (std::bit_cast<uint32_t>(v) & 0x7f800000u) == 0x7f800000u ? 1u : 0u;
}

// Number of the n spheres that have a value that is not finite.
FATHOM_CLONES uint32_t countNotFinite(const float* x, const float* y, const float* z, const float* radius,
                                      size_t n) noexcept {
    uint32_t count = 0;
    for (size_t i = 0; i < n; ++i) {
        count += isNotFinite(x[i]) | isNotFinite(y[i]) | isNotFinite(z[i]) | isNotFinite(radius[i]);
    }
    return count;
}

FATHOM_CLONES void boundsOf(const float* v, size_t n, float& lo, float& hi) noexcept {
    constexpr float kFar = std::numeric_limits<float>::infinity();
    std::array<Lanes, kBoundRows> low, high;
    low.fill(Lanes{} + kFar), high.fill(Lanes{} - kFar);
    size_t i = 0;
    for (; i + kBoundRows * kBoundLanes <= n; i += kBoundRows * kBoundLanes) {
        for (size_t row = 0; row < kBoundRows; ++row) {
            Lanes some;
            std::memcpy(&some, v + i + row * kBoundLanes, sizeof some);
            low[row] = some < low[row] ? some : low[row];
            high[row] = some > high[row] ? some : high[row];
        }
    }
    lo = kFar;
    hi = -kFar;
    for (size_t l = 0; l < kBoundRows * kBoundLanes; ++l) {
        lo = std::min(lo, low[l / kBoundLanes][l % kBoundLanes]);
        hi = std::max(hi, high[l / kBoundLanes][l % kBoundLanes]);
    }
    for (; i < n; ++i) {
        lo = std::min(lo, v[i]);
        hi = std::max(hi, v[i]);
    }
}

FATHOM_CLONES double sumOf(const float* v, size_t n) noexcept {
    std::array<double, kBoundLanes> sums{};
    size_t i = 0;
    for (; i + kBoundLanes <= n; i += kBoundLanes) {
        for (size_t l = 0; l < kBoundLanes; ++l) {
            sums[l] += static_cast<double>(v[i + l]);
        }
    }
    for (; i < n; ++i) {
        sums[0] += static_cast<double>(v[i]);
    }
    return std::accumulate(sums.begin(), sums.end(), 0.0);
}

// RegionGrid::cellOf for one axis of a column: cell[i] = cell[i] * count + its cell. NaN goes into the first
// cell.
FATHOM_CLONES void addAxis(const float* v, size_t n, double lo, double perMetre, int32_t count,
                           uint32_t* cell) noexcept {
    const double last = count - 1;
    for (size_t i = 0; i < n; ++i) {
        double at = (static_cast<double>(v[i]) - lo) * perMetre;
        at = at > 0.0 ? at : 0.0;
        at = at < last ? at : last;
        cell[i] = cell[i] * static_cast<uint32_t>(count) + static_cast<uint32_t>(static_cast<int32_t>(at));
    }
}

} // namespace

void RegionGrid::build(const RegionSpheres& spheres, ThreadPool* workers) {
    build(spheres.x, spheres.y, spheres.z, spheres.radius, workers);
}

void RegionGrid::build(std::span<const float> x, std::span<const float> y, std::span<const float> z,
                       std::span<const float> radius, ThreadPool* workers) {
    measure({x, y, z, radius}, workers);
    const auto notFinite = [](const Extent& e) { return e.notFinite > 0; };
    if (std::none_of(extents_.begin(), extents_.end(), notFinite)) {
        buildOf({x, y, z, radius}, workers);
        return;
    }
    std::array<std::vector<float>, 4> kept;
    std::vector<uint32_t> from;
    for (size_t i = 0; i < x.size(); ++i) {
        if ((isNotFinite(x[i]) | isNotFinite(y[i]) | isNotFinite(z[i]) | isNotFinite(radius[i])) == 0) {
            kept[0].push_back(x[i]);
            kept[1].push_back(y[i]);
            kept[2].push_back(z[i]);
            kept[3].push_back(radius[i]);
            from.push_back(static_cast<uint32_t>(i));
        }
    }
    const Columns columns{kept[0], kept[1], kept[2], kept[3]};
    measure(columns, nullptr);
    buildOf(columns, nullptr);
    for (uint32_t& index : order_) {
        index = from[index];
    }
}

// In runs of fixed length, so that sums do not depend on the threads.
void RegionGrid::measure(const Columns& columns, ThreadPool* workers) {
    const size_t n = columns[0].size();
    extents_.resize((n + kRun - 1) / kRun);
    inParts(workers, extents_.size(), 1, [&](size_t begin, size_t end) {
        for (size_t run = begin; run < end; ++run) {
            const size_t first = run * kRun, count = std::min(kRun, n - first);
            std::array<const float*, 4> v;
            Extent& e = extents_[run];
            for (size_t a = 0; a < 4; ++a) {
                v[a] = columns[a].data() + first;
                boundsOf(v[a], count, e.lo[a], e.hi[a]);
            }
            e.radii = sumOf(v[3], count);
            e.notFinite = countNotFinite(v[0], v[1], v[2], v[3], count);
        }
    });
}

void RegionGrid::buildOf(const Columns& columns, ThreadPool* workers) {
    const size_t n = columns[0].size();
    for (std::vector<float>* column : {&x_, &y_, &z_, &radius_}) {
        column->resize(n);
    }
    order_.resize(n);
    if (n == 0) {
        maxRadius_ = spheresPerMetre_ = 0.0;
        nx_ = ny_ = nz_ = 0;
        return;
    }
    Extent all = extents_.front();
    for (size_t run = 1; run < extents_.size(); ++run) {
        const Extent& e = extents_[run];
        for (size_t a = 0; a < 4; ++a) {
            all.lo[a] = std::min(all.lo[a], e.lo[a]);
            all.hi[a] = std::max(all.hi[a], e.hi[a]);
        }
        all.radii += e.radii;
    }
    lo_ = dvec3(all.lo[0], all.lo[1], all.lo[2]);
    hi_ = dvec3(all.hi[0], all.hi[1], all.hi[2]);
    maxRadius_ = std::max(0.0f, all.hi[3]);
    chooseCells(all.radii / static_cast<double>(n));
    layOut(columns, workers);
}

void RegionGrid::chooseCells(double meanRadius) {
    const dvec3 extent = hi_ - lo_;
    const double most = static_cast<double>(
        std::min(kMaxCells, std::max<uint64_t>(kFewestCells, kCellsPerSphere * x_.size())));
    size_ = std::max(kSmallestCell, 0.5 * meanRadius);
    // Coarsen until the cell count fits. Counted in double because the extent can be arbitrarily large.
    while ((extent.x / size_ + 1.0) * (extent.y / size_ + 1.0) * (extent.z / size_ + 1.0) > most) {
        size_ *= 1.1;
    }
    perMetre_ = 1.0 / size_;
    nx_ = cellsAlong(extent.x, size_);
    ny_ = cellsAlong(extent.y, size_);
    nz_ = cellsAlong(extent.z, size_);
}

void RegionGrid::layOut(const Columns& columns, ThreadPool* workers) {
    const size_t n = columns[0].size();
    const auto cells = static_cast<uint32_t>(nx_ * ny_ * nz_);
    cellBegin_.resize(size_t{cells} + 1);
    cell_.resize(n);
    uint32_t* const cell = cell_.data();
    inParts(workers, n, kRun, [&](size_t first, size_t end) {
        for (size_t at = first; at < end;
             at += kRun) { // per batch, so that the cells written by one axis are still cached for the next
            const size_t count = std::min(kRun, end - at);
            std::fill_n(cell + at, count, 0);
            addAxis(columns[2].data() + at, count, lo_.z, perMetre_, static_cast<int32_t>(nz_), cell + at);
            addAxis(columns[1].data() + at, count, lo_.y, perMetre_, static_cast<int32_t>(ny_), cell + at);
            addAxis(columns[0].data() + at, count, lo_.x, perMetre_, static_cast<int32_t>(nx_), cell + at);
        }
    });
    const float *const x = columns[0].data(), *const y = columns[1].data(), *const z = columns[2].data(),
                       *const radius = columns[3].data();
    float *const toX = x_.data(), *const toY = y_.data(), *const toZ = z_.data(),
                 *const toRadius = radius_.data();
    uint32_t* const order = order_.data();
    sort_.sort(
        cell_, cells, cellBegin_,
        [=](uint32_t i, uint32_t slot) {
            order[slot] = i;
            toX[slot] = x[i];
            toY[slot] = y[i];
            toZ[slot] = z[i];
            toRadius[slot] = radius[i];
        },
        workers);
    markUsedCells(workers);
}

void RegionGrid::markUsedCells(ThreadPool* workers) {
    used_.assign(static_cast<size_t>(ny_ * nz_), UsedCells{});
    inParts(workers, used_.size(), kRun, [&](size_t first, size_t end) {
        for (size_t row = first; row < end; ++row) {
            const uint32_t begin = cellBegin_[row * static_cast<size_t>(nx_)],
                           after = cellBegin_[(row + 1) * static_cast<size_t>(nx_)];
            if (begin < after) {
                used_[row] = {static_cast<int32_t>(cellOf(x_[begin], lo_.x, perMetre_, nx_)),
                              static_cast<int32_t>(cellOf(x_[after - 1], lo_.x, perMetre_, nx_))};
            }
        }
    });
    int64_t cells = 0;
    for (const UsedCells& used : used_) {
        cells += used.first > used.last ? 0 : used.last - used.first + 1;
    }
    spheresPerMetre_ = static_cast<double>(x_.size()) * perMetre_ / static_cast<double>(cells);
}

} // namespace fathom
