// SPDX-License-Identifier: Apache-2.0
// Uniform grid over all spheres of a set, built by counting sort. Cells are contiguous in x, so a row of
// cells is one run.
#pragma once

#include "engine/contact/cell_sort.h"
#include "engine/contact/host_fixtures.h"
#include "engine/contact/sphere_span.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

namespace fathom {

// Built once per frame at contact or frame cadence (allocates). Queries are const, noexcept and do not
// allocate. Cells are about half a mean sphere radius, at least 5 mm, and coarser when the extent would need
// more than 8 cells per sphere (4 Mi at most). So outliers cost speed, never memory or results. Spheres that
// are not finite are skipped.
class RegionGrid {
public:
    // The grid does not depend on the thread pool. Null = the calling thread only.
    void build(const RegionSpheres& spheres, ThreadPool* workers = nullptr);
    // The same over plain arrays of equal length.
    void build(std::span<const float> x, std::span<const float> y, std::span<const float> z,
               std::span<const float> radius, ThreadPool* workers = nullptr);

    size_t size() const { return x_.size(); }
    double maxRadius() const { return maxRadius_; } // [m], 0 when empty
    // Mean number of spheres per metre of x, between the first and the last sphere of each row of cells.
    double spheresPerMetre() const { return spheresPerMetre_; }

    // Calls visit(index into RegionSpheres) for a superset of the spheres whose centre is within `distance`
    // of `point` (about the set's origin) [m].
    template <class Visit>
    void forEachNear(const dvec3& point, double distance, Visit&& visit) const {
        forEachRun(point, distance, [&](uint32_t begin, uint32_t end) {
            for (uint32_t slot = begin; slot < end; ++slot) {
                visit(order_[slot]);
            }
        });
    }

    // The same superset as runs of slots [begin, end) in cell order, for kernels that read the arrays below.
    template <class Visit>
    void forEachRun(const dvec3& point, double distance, Visit&& visit) const;

    // In cell order (slots).
    std::span<const float> x() const { return x_; }
    std::span<const float> y() const { return y_; }
    std::span<const float> z() const { return z_; }
    std::span<const float> radius() const { return radius_; }
    std::span<const uint32_t> order() const { return order_; } // slot -> index into the input of build()
    // Slots [begin, begin + count).
    SphereSpan run(size_t begin, size_t count) const {
        return {x_.data() + begin, y_.data() + begin, z_.data() + begin, radius_.data() + begin, count};
    }

private:
    // Monotone in v, and the same function for spheres and query boxes, so rounding cannot lose a sphere.
    static int64_t cellOf(double v, double lo, double perMetre, int64_t count) noexcept {
        const double cell = (v - lo) * perMetre;
        if (!(cell > 0.0)) {
            return 0;
        }
        return cell >= static_cast<double>(count) ? count - 1 : static_cast<int64_t>(cell);
    }
    // Distance from v to the cell's interval, rounded towards zero [m].
    double outside(double v, double lo, int64_t cell, int64_t count) const noexcept {
        const double slack = 1e-3 * size_;
        // The first and the last cell also hold spheres that rounding moved over the edge, so they count as
        // unbounded.
        const double below = cell == 0 ? 0.0 : lo + static_cast<double>(cell) * size_ - slack - v;
        const double above =
            cell + 1 == count ? 0.0 : v - (lo + static_cast<double>(cell + 1) * size_ + slack);
        return std::max({0.0, below, above});
    }
    using Columns = std::array<std::span<const float>, 4>; // x, y, z, radius; all finite but in measure()
    // First and last cell of a row that contains a sphere; first > last: none.
    struct UsedCells {
        int32_t first = std::numeric_limits<int32_t>::max(), last = -1;
    };
    // Extent of a run of spheres.
    struct Extent {
        std::array<float, 4> lo, hi; // x, y, z, radius
        double radii;                // their sum
        uint32_t notFinite;          // spheres that are not finite
    };
    void measure(const Columns& columns, ThreadPool* workers);
    void buildOf(const Columns& columns, ThreadPool* workers);
    void chooseCells(double meanRadius);
    void layOut(const Columns& columns, ThreadPool* workers);
    void markUsedCells(ThreadPool* workers);

    std::vector<float> x_, y_, z_, radius_;
    std::vector<uint32_t> order_;
    std::vector<uint32_t> cellBegin_; // cells + 1
    std::vector<UsedCells> used_;     // per row
    std::vector<uint32_t> cell_;      // build scratch: cell of each sphere
    std::vector<Extent> extents_;     // build scratch: extent of each run of spheres
    CellSort sort_;                   // build scratch
    double maxRadius_ = 0.0, spheresPerMetre_ = 0.0;
    dvec3 lo_{0.0}, hi_{0.0};
    double size_ = 1.0, perMetre_ = 1.0;
    int64_t nx_ = 0, ny_ = 0, nz_ = 0;
};

template <class Visit>
void RegionGrid::forEachRun(const dvec3& point, double distance, Visit&& visit) const {
    if (x_.empty() || !(distance >= 0.0) || point.x + distance < lo_.x || point.x - distance > hi_.x ||
        point.y + distance < lo_.y || point.y - distance > hi_.y || point.z + distance < lo_.z ||
        point.z - distance > hi_.z) {
        return;
    }
    const int64_t z0 = cellOf(point.z - distance, lo_.z, perMetre_, nz_);
    const int64_t z1 = cellOf(point.z + distance, lo_.z, perMetre_, nz_);
    const int64_t y0 = cellOf(point.y - distance, lo_.y, perMetre_, ny_);
    const int64_t y1 = cellOf(point.y + distance, lo_.y, perMetre_, ny_);
    const int64_t x0 = cellOf(point.x - distance, lo_.x, perMetre_, nx_);
    const int64_t x1 = cellOf(point.x + distance, lo_.x, perMetre_, nx_);
    const double d2 = distance * distance;
    for (int64_t cz = z0; cz <= z1; ++cz) {
        const double dz = outside(point.z, lo_.z, cz, nz_);
        for (int64_t cy = y0; cy <= y1; ++cy) {
            const UsedCells used = used_[static_cast<size_t>(cz * ny_ + cy)];
            if (used.first > x1 || used.last < x0) {
                continue; // as most rows near a surface
            }
            const double dy = outside(point.y, lo_.y, cy, ny_);
            const double left = d2 - dz * dz - dy * dy; // the ball's width in x at this row
            if (left < 0.0) {
                continue;
            }
            const double half = std::sqrt(left) * (1.0 + 1e-12);
            const int64_t row = (cz * ny_ + cy) * nx_;
            const uint32_t begin = cellBegin_[row + cellOf(point.x - half, lo_.x, perMetre_, nx_)];
            const uint32_t end = cellBegin_[row + cellOf(point.x + half, lo_.x, perMetre_, nx_) + 1];
            if (begin < end) {
                visit(begin, end);
            }
        }
    }
}

} // namespace fathom
