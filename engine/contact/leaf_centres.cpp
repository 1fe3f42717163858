// SPDX-License-Identifier: Apache-2.0
#include "engine/contact/leaf_centres.h"

#include "engine/contact/clones.h"

#include <cmath>
#include <cstdint>
#include <cstring>

namespace fathom {

namespace {

constexpr size_t kDisplacementLanes = 8; // lanes of the widest register, each with its own maximum
using DisplacementLanes = double __attribute__((vector_size(8 * kDisplacementLanes)));

FATHOM_CLONES
void displacementsKernel(const double* __restrict fx, const double* __restrict fy,
                         const double* __restrict fz, const double* __restrict tx,
                         const double* __restrict ty, const double* __restrict tz, size_t count,
                         double* __restrict displacements) noexcept {
    for (size_t i = 0; i < count; ++i) {
        const double dx = tx[i] - fx[i], dy = ty[i] - fy[i], dz = tz[i] - fz[i];
        displacements[i] = std::sqrt(dx * dx + dy * dy + dz * dz);
    }
}

FATHOM_CLONES
int64_t withinKernel(const double* __restrict fx, const double* __restrict fy, const double* __restrict fz,
                     const double* __restrict tx, const double* __restrict ty, const double* __restrict tz,
                     size_t count, double limit2) noexcept {
    int64_t within = 0;
    for (size_t i = 0; i < count; ++i) {
        const double dx = tx[i] - fx[i], dy = ty[i] - fy[i], dz = tz[i] - fz[i];
        within += dx * dx + dy * dy + dz * dz <= limit2 ? 1 : 0;
    }
    return within;
}

// Largest squared displacement. No vector types in the signature, because each clone has its own calling
// convention.
FATHOM_CLONES
double farthestKernel(const double* __restrict fx, const double* __restrict fy, const double* __restrict fz,
                      const double* __restrict tx, const double* __restrict ty, const double* __restrict tz,
                      size_t count) noexcept {
    DisplacementLanes most{}, ax, ay, az, bx, by, bz;
    size_t i = 0;
    for (; i + kDisplacementLanes <= count; i += kDisplacementLanes) {
        std::memcpy(&ax, fx + i, sizeof ax);
        std::memcpy(&bx, tx + i, sizeof bx);
        std::memcpy(&ay, fy + i, sizeof ay);
        std::memcpy(&by, ty + i, sizeof by);
        std::memcpy(&az, fz + i, sizeof az);
        std::memcpy(&bz, tz + i, sizeof bz);
        const DisplacementLanes dx = bx - ax, dy = by - ay, dz = bz - az;
        const DisplacementLanes square = dx * dx + dy * dy + dz * dz;
        most = square > most ? square : most;
    }
    double farthest = 0.0;
    for (size_t l = 0; l < kDisplacementLanes; ++l) {
        farthest = most[l] > farthest ? most[l] : farthest;
    }
    for (; i < count; ++i) {
        const double dx = tx[i] - fx[i], dy = ty[i] - fy[i], dz = tz[i] - fz[i];
        const double square = dx * dx + dy * dy + dz * dz;
        farthest = square > farthest ? square : farthest;
    }
    return farthest;
}

} // namespace

void leafDisplacements(const LeafCentres& from, const LeafCentres& to,
                       std::span<double> displacements) noexcept {
    displacementsKernel(from.x.data(), from.y.data(), from.z.data(), to.x.data(), to.y.data(), to.z.data(),
                        from.size(), displacements.data());
}

double leafDisplacement(const LeafCentres& from, const LeafCentres& to) noexcept {
    return std::sqrt(farthestKernel(from.x.data(), from.y.data(), from.z.data(), to.x.data(), to.y.data(),
                                    to.z.data(), from.size()));
}

bool leavesWithin(const LeafCentres& from, const LeafCentres& to, double limit) noexcept {
    const int64_t within = withinKernel(from.x.data(), from.y.data(), from.z.data(), to.x.data(), to.y.data(),
                                        to.z.data(), from.size(), limit * limit);
    return static_cast<size_t>(within) == from.size() && (limit >= 0.0 || from.size() == 0);
}

} // namespace fathom
