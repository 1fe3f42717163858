// SPDX-License-Identifier: Apache-2.0
// The outline of many spheres in a camera image: their union as a mask, and the border of a mask as lines.
#pragma once

#include "apps/output/image_view.h"
#include "engine/contact/host_fixtures.h"
#include "engine/types/sphere_tree.h"

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

namespace fathom {

// Accumulates spheres. The cost of a sphere grows with its height in pixels, not its area: it adds one run
// per row, and mask() sums the runs. Runs are exact for a pinhole, where the silhouette is a conic section.
// Lens distortion is evaluated at the centre of the sphere.
class Silhouette {
public:
    explicit Silhouette(const ImageView& view);

    void add(const dvec3& baseCentre, double radius); // [m]
    // From now on add() ignores a sphere that all spheres so far cover. The mask stays the same.
    void settle();
    // 1 for pixels whose centre is covered by a sphere; width x height, row-major.
    std::vector<uint8_t> mask() const;

    // Pixels [u0, u1) x [v0, v1).
    struct Box {
        int u0 = 0, v0 = 0, u1 = 0, v1 = 0;
        int width() const { return std::max(0, u1 - u0); }
        int height() const { return std::max(0, v1 - v0); }
    };
    Box covered() const; // all covered pixels and a margin, inside the image; empty without any
    std::vector<uint8_t> mask(const Box& box) const;

private:
    void addRow(int v, double from, double to);
    bool covers(const dvec3& c, double radius, glm::dvec2 focal, glm::dvec2 middle) const;
    bool isFull(glm::dvec2 middle, glm::dvec2 half) const; // a rectangle

    const ImageView view_;
    int width_, height_;
    Box box_{1 << 30, 1 << 30, 0, 0}; // of the covered pixels
    std::vector<int32_t> steps_;      // rows of width + 1 counts: runs that start minus runs that end here
    std::vector<int32_t> settled_;    // empty: settle() was never called
    Box settledBox_;
};

// Centre of a region sphere in the base frame [m].
inline dvec3 regionCentre(const HostFixtures& set, size_t i) {
    const RegionSpheres& s = set.spheres;
    return set.origin + dvec3(double{s.x[i]}, double{s.y[i]}, double{s.z[i]});
}

// The pixels of a view that the regions of a set cover.
struct RegionMasks {
    std::vector<uint8_t> seen, held; // held: only pixels without a seen region
    bool anyHeld = false;            // some pixel of `held` is set
};
RegionMasks regionMasks(const ImageView& view, const HostFixtures& set);

using OutlineLine = std::vector<glm::dvec2>; // [pixels], corners of pixels, smoothed

// The borders of a mask as lines between pixels, with the inside to the right. A line ends at the edge of the
// image; all others are closed (first point = last point). Skips borders shorter than `least` pixels.
std::vector<OutlineLine> traceOutline(const std::vector<uint8_t>& mask, int width, int height, size_t least);
// As traceOutline(), but all lines are closed, along the edge of the image too: borders of an area to fill.
std::vector<OutlineLine> traceArea(const std::vector<uint8_t>& mask, int width, int height);
// The outline of spheres whose centres are in the base frame.
std::vector<OutlineLine> outlineOf(const ImageView& view, std::span<const Sphere> spheres);
// The borders of the area that they cover, all closed.
std::vector<OutlineLine> areaOf(const ImageView& view, std::span<const Sphere> spheres);

} // namespace fathom
