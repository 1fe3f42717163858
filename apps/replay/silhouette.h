// SPDX-License-Identifier: Apache-2.0
// Outline of many spheres together, as a camera sees it: their union as a mask, and the mask's border as
// lines.
#pragma once

#include "apps/replay/image_view.h"

#include <cstdint>
#include <vector>

namespace fathom {

// Each sphere costs its height in pixels, not its area: it adds one run a row, and the runs are summed up at
// the end. The run is exact for a pinhole (the silhouette is a cone's section, an ellipse off the axis); the
// lens distortion is taken at the sphere's centre.
class Silhouette {
public:
    explicit Silhouette(const ImageView& view);

    void add(const dvec3& baseCentre, double radius); // [m]
    // 1 where some sphere covers the centre of the pixel; width x height, rows from the top.
    std::vector<uint8_t> mask() const;

private:
    void addRow(int v, double from, double to);

    const ImageView view_;
    int width_, height_;
    std::vector<int32_t> steps_; // by row, width + 1: how many runs begin less how many ended
};

using OutlineLine = std::vector<glm::dvec2>; // [pixels], corners of pixels, smoothed

// Borders of a mask as lines between pixels, inside to the right; a line that meets the picture's edge ends
// there, every other is closed (first point = last point). Borders shorter than `least` pixels are left out.
std::vector<OutlineLine> traceOutline(const std::vector<uint8_t>& mask, int width, int height, size_t least);

} // namespace fathom
