// SPDX-License-Identifier: Apache-2.0
// Twin of shaders/spheres.comp: region spheres, forbidden pixels, leaks, bounds of 4x4 sub-patches (paper
// IV.B.1, eq. 3).
#pragma once

#include "engine/reference/frame_view.h"

#include <array>

namespace fathom::reference {

struct RegionSphere {
    dvec3 centre{0.0};    // [m] base frame
    double radius = -1.0; // [m]; < 0 = none
    int cls = -1;         // point class, -1 = none
};

// The class whose sphere a pixel gets: the forbidden class with the largest radius, then the first in the
// file; -1 = none.
int forbiddenClass(const Scene& scene, uint32_t mask);

// Class of the forbidden point at each pixel; -1 where the pixel has no point or no forbidden class.
std::vector<int> forbiddenClasses(const Scene& scene, std::span<const uint32_t> masks,
                                  const PointImage& points);

// Radius of a class's region [m], including 3 sigma of the registration.
double regionRadius(const Scene& scene, int cls);

// Growth of each point's sphere for its own sigma [m]: 3 sigma of the beam at its range; zeros without beams.
std::vector<double> beamGrowth(const FrameView& view, const PointImage& points);

// One sphere per kept point. growth [m]: added by thinning, -1 = dropped; empty = every point is kept.
std::vector<RegionSphere> spheres(const Scene& scene, std::span<const int> classes, const PointImage& points,
                                  std::span<const double> growth);

// Leaks: neighbours (right, below) of one class on one surface that are at least R apart. Largest spacing and
// range per class [m], 0 = none. A depth step of more than 0.7 of the distance (steeper than 45 degrees) is
// an edge, not a surface.
struct Leaks {
    std::array<double, 8> spacing{}, range{};
};
Leaks leaks(const Scene& scene, int width, int height, std::span<const int> classes,
            const PointImage& points);

// Bound of spheres: centre = mean, radius = max(|s - centre| + r); radius -1 for none.
struct Bound {
    dvec3 centre{0.0};
    double radius = -1.0;
    uint32_t count = 0;
};
Bound boundOf(std::span<const RegionSphere> spheres);

} // namespace fathom::reference
