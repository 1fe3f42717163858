// SPDX-License-Identifier: Apache-2.0
#include "engine/contact/region_grid.h"

#include <limits>

namespace fathom {

namespace {

constexpr double kSmallestCell = 0.005;   // [m]
constexpr uint64_t kMostCells = 4u << 20; // 16 MiB of cell starts
constexpr uint64_t kFewestCells = 4096;   // below this clearing costs nothing
constexpr uint64_t kCellsPerSphere = 8;   // clearing and summing stay cheaper than sorting the spheres
constexpr uint32_t kNoCell = std::numeric_limits<uint32_t>::max();

bool hasPlace(float x, float y, float z, float radius) {
    return std::isfinite(x) && std::isfinite(y) && std::isfinite(z) && std::isfinite(radius);
}

int64_t cellsAlong(double extent, double size) {
    return static_cast<int64_t>(extent / size) + 1;
}

} // namespace

void RegionGrid::build(const RegionSpheres& spheres) {
    build(spheres.x, spheres.y, spheres.z, spheres.radius);
}

void RegionGrid::build(std::span<const float> x, std::span<const float> y, std::span<const float> z,
                       std::span<const float> radius) {
    const double meanRadius = measure(x, y, z, radius);
    if (x_.empty()) {
        nx_ = ny_ = nz_ = 0;
        return;
    }
    const dvec3 extent = hi_ - lo_;
    const double most = static_cast<double>(
        std::min(kMostCells, std::max<uint64_t>(kFewestCells, kCellsPerSphere * x_.size())));
    size_ = std::max(kSmallestCell, 0.5 * meanRadius);
    // Coarser until it fits; counted in double because the extent may be anything.
    while ((extent.x / size_ + 1.0) * (extent.y / size_ + 1.0) * (extent.z / size_ + 1.0) > most) {
        size_ *= 1.1;
    }
    perMetre_ = 1.0 / size_;
    nx_ = cellsAlong(extent.x, size_);
    ny_ = cellsAlong(extent.y, size_);
    nz_ = cellsAlong(extent.z, size_);
    layOut(x, y, z, radius);
}

double RegionGrid::measure(std::span<const float> x, std::span<const float> y, std::span<const float> z,
                           std::span<const float> radius) {
    float lo[3], hi[3];
    std::fill_n(lo, 3, std::numeric_limits<float>::infinity());
    std::fill_n(hi, 3, -std::numeric_limits<float>::infinity());
    float largest = 0.0f;
    double radii = 0.0;
    size_t count = 0;
    for (size_t i = 0; i < x.size(); ++i) {
        if (!hasPlace(x[i], y[i], z[i], radius[i])) {
            continue;
        }
        const float p[3] = {x[i], y[i], z[i]};
        for (int a = 0; a < 3; ++a) {
            lo[a] = std::min(lo[a], p[a]);
            hi[a] = std::max(hi[a], p[a]);
        }
        largest = std::max(largest, radius[i]);
        radii += radius[i];
        ++count;
    }
    maxRadius_ = largest;
    lo_ = dvec3(lo[0], lo[1], lo[2]);
    hi_ = dvec3(hi[0], hi[1], hi[2]);
    for (std::vector<float>* column : {&x_, &y_, &z_, &radius_}) {
        column->resize(count);
    }
    order_.resize(count);
    return count > 0 ? radii / static_cast<double>(count) : 0.0;
}

void RegionGrid::layOut(std::span<const float> x, std::span<const float> y, std::span<const float> z,
                        std::span<const float> radius) {
    const size_t cells = static_cast<size_t>(nx_ * ny_ * nz_);
    cellBegin_.assign(cells + 1, 0);
    cell_.resize(x.size());
    for (size_t i = 0; i < x.size(); ++i) {
        if (!hasPlace(x[i], y[i], z[i], radius[i])) {
            cell_[i] = kNoCell;
            continue;
        }
        const int64_t cx = cellOf(x[i], lo_.x, perMetre_, nx_);
        const int64_t cy = cellOf(y[i], lo_.y, perMetre_, ny_);
        const int64_t cz = cellOf(z[i], lo_.z, perMetre_, nz_);
        cell_[i] = static_cast<uint32_t>((cz * ny_ + cy) * nx_ + cx);
        ++cellBegin_[cell_[i]];
    }
    uint32_t sum = 0;
    for (uint32_t& begin :
         cellBegin_) { // running end of each cell; the scatter below walks it back to its begin
        sum += begin;
        begin = sum;
    }
    for (size_t i = x.size(); i-- > 0;) { // backwards: keeps the order of the input within a cell
        if (cell_[i] == kNoCell) {
            continue;
        }
        const uint32_t slot = --cellBegin_[cell_[i]];
        x_[slot] = x[i];
        y_[slot] = y[i];
        z_[slot] = z[i];
        radius_[slot] = radius[i];
        order_[slot] = static_cast<uint32_t>(i);
    }
}

} // namespace fathom
