// SPDX-License-Identifier: Apache-2.0
#include "apps/profile/region_boundary.h"

#include "engine/contact/region_grid.h"
#include "engine/types/pose.h"

#include <algorithm>
#include <cmath>
#include <random>

namespace fathom::profile {

namespace {

constexpr double kOnSurface = 1e-8; // [m]
constexpr int kMaxSteps = 400;

class Region {
public:
    explicit Region(const RegionSpheres& spheres)
        : s_(spheres) {
        grid_.build(spheres);
    }

    size_t size() const { return s_.size(); }
    dvec3 centre(size_t i) const { return {s_.x[i], s_.y[i], s_.z[i]}; }
    double radius(size_t i) const { return s_.radius[i]; }
    double maxRadius() const { return grid_.maxRadius(); }

    // Distance [m] to the union, negative inside. Exact up to `bound`, otherwise any value above it.
    double distance(const dvec3& p, double bound) const {
        double least = HUGE_VAL;
        grid_.forEachNear(p, bound + grid_.maxRadius(), [&](uint32_t i) {
            least = std::min(least, glm::length(centre(i) - p) - radius(i));
        });
        return least;
    }

private:
    const RegionSpheres& s_;
    RegionGrid grid_;
};

// Finds a boundary point with a ray from outside. False if the ray starts inside or does not converge because
// it grazes the surface.
bool boundaryPoint(const Region& region, std::mt19937_64& random, dvec3& point) {
    std::uniform_int_distribution<size_t> any(0, region.size() - 1);
    std::normal_distribution<double> n;
    const double x = n(random), y = n(random), z = n(random);
    const size_t target = any(random);
    const dvec3 out = glm::normalize(dvec3(x, y, z));
    double left = 3.0 * region.maxRadius();
    point = region.centre(target) + left * out;
    for (int i = 0; i < kMaxSteps; ++i) {
        const double d = region.distance(point, left);
        if (i == 0 && d <= 0.0) {
            return false;
        }
        if (d <= kOnSurface) {
            return true;
        }
        point -= d * out;
        left = std::max(0.0, left - d);
    }
    return false;
}

} // namespace

BoundaryError boundaryError(const RegionSpheres& all, const RegionSpheres& kept, uint32_t samples,
                            uint64_t seed) {
    const Region whole(all), thinned(kept);
    std::mt19937_64 random(seed);
    BoundaryError error;
    double squares = 0.0;
    const double bound = 0.005;
    for (uint32_t tried = 0; tried < 4 * samples && error.samples < samples; ++tried) {
        const bool ofAll = tried % 2 == 0;
        dvec3 point;
        if (!boundaryPoint(ofAll ? whole : thinned, random, point)) {
            continue;
        }
        // The kept region contains the whole one, so the sign of the distance differs by direction.
        const double d = (ofAll ? thinned : whole).distance(point, bound);
        const double size = std::min(std::abs(d), bound);
        error.worstInside = std::max(error.worstInside, ofAll ? d : -d);
        error.max = std::max(error.max, size);
        squares += size * size;
        ++error.samples;
    }
    error.rms = error.samples > 0 ? std::sqrt(squares / error.samples) : 0.0;
    return error;
}

} // namespace fathom::profile
