// SPDX-License-Identifier: Apache-2.0
#include "engine/contact/leaf_centres.h"

#include "engine/contact/clones.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

namespace fathom {

namespace {

constexpr size_t kWayLanes = 8; // of the widest register; each has a largest of its own

FATHOM_CLONES
void waysKernel(const double* __restrict fx, const double* __restrict fy, const double* __restrict fz,
                const double* __restrict tx, const double* __restrict ty, const double* __restrict tz,
                size_t count, double* __restrict ways) noexcept {
    for (size_t i = 0; i < count; ++i) {
        const double dx = tx[i] - fx[i], dy = ty[i] - fy[i], dz = tz[i] - fz[i];
        ways[i] = std::sqrt(dx * dx + dy * dy + dz * dz);
    }
}

FATHOM_CLONES
int64_t withinKernel(const double* __restrict fx, const double* __restrict fy, const double* __restrict fz,
                     const double* __restrict tx, const double* __restrict ty, const double* __restrict tz,
                     size_t count, double limit) noexcept {
    int64_t within = 0;
    for (size_t i = 0; i < count; ++i) {
        const double dx = tx[i] - fx[i], dy = ty[i] - fy[i], dz = tz[i] - fz[i];
        within += std::sqrt(dx * dx + dy * dy + dz * dz) <= limit ? 1 : 0;
    }
    return within;
}

// The farthest, squared.
FATHOM_CLONES
double farthestKernel(const double* __restrict fx, const double* __restrict fy, const double* __restrict fz,
                      const double* __restrict tx, const double* __restrict ty, const double* __restrict tz,
                      size_t count) noexcept {
    std::array<double, kWayLanes> most{};
    for (size_t i = 0; i < count / kWayLanes * kWayLanes; i += kWayLanes) {
        for (size_t l = i; l < i + kWayLanes; ++l) {
            const double dx = tx[l] - fx[l], dy = ty[l] - fy[l], dz = tz[l] - fz[l];
            const double square = dx * dx + dy * dy + dz * dz;
            most[l - i] = square > most[l - i] ? square : most[l - i];
        }
    }
    for (size_t i = count / kWayLanes * kWayLanes; i < count; ++i) {
        const double dx = tx[i] - fx[i], dy = ty[i] - fy[i], dz = tz[i] - fz[i];
        const double square = dx * dx + dy * dy + dz * dz;
        most[0] = square > most[0] ? square : most[0];
    }
    return *std::max_element(most.begin(), most.end());
}

FATHOM_CLONES
double largestKernel(const double* __restrict values, size_t count) noexcept {
    std::array<double, kWayLanes> most{};
    size_t i = 0;
    for (; i + kWayLanes <= count; i += kWayLanes) {
        for (size_t l = 0; l < kWayLanes; ++l) {
            most[l] = values[i + l] > most[l] ? values[i + l] : most[l];
        }
    }
    for (; i < count; ++i) {
        most[0] = values[i] > most[0] ? values[i] : most[0];
    }
    return *std::max_element(most.begin(), most.end());
}

} // namespace

double straightWays(const LeafCentres& from, const LeafCentres& to, std::span<double> ways) noexcept {
    waysKernel(from.x.data(), from.y.data(), from.z.data(), to.x.data(), to.y.data(), to.z.data(),
               from.size(), ways.data());
    return largestKernel(ways.data(), from.size());
}

double farthestWay(const LeafCentres& from, const LeafCentres& to) noexcept {
    return std::sqrt(farthestKernel(from.x.data(), from.y.data(), from.z.data(), to.x.data(), to.y.data(),
                                    to.z.data(), from.size()));
}

bool waysWithin(const LeafCentres& from, const LeafCentres& to, double limit) noexcept {
    const int64_t within = withinKernel(from.x.data(), from.y.data(), from.z.data(), to.x.data(), to.y.data(),
                                        to.z.data(), from.size(), limit);
    return static_cast<size_t>(within) == from.size();
}

} // namespace fathom
