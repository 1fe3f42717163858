// SPDX-License-Identifier: Apache-2.0
#include "engine/reference/self_filter.h"

#include <cmath>
#include <glm/geometric.hpp>

namespace fathom::reference {

namespace {

constexpr double kSlack =
    5e-6; // [m] float32 rounding at metres, plus the outward rounding of the shader's spheres

} // namespace

void removeArm(const FrameView& view, std::span<const Sphere> spheres, ClassImage& image) {
    for (int v = 0; v < view.height(); ++v) {
        for (int u = 0; u < view.width(); ++u) {
            const double z = view.z(u, v);
            const size_t i = view.index(u, v);
            if (z == 0.0 || image.masks[i] == 0) {
                continue;
            }
            const dvec3 p = view.baseTcamera().apply(view.point(u, v, z));
            bool inside = false;
            for (const Sphere& s : spheres) {
                const double depth = s.radius - glm::distance(p, s.centre);
                inside = inside || depth >= 0.0;
                image.unsure[i] = std::abs(depth) <= kSlack ? 1 : image.unsure[i];
            }
            image.masks[i] = inside ? 0 : image.masks[i];
        }
    }
}

} // namespace fathom::reference
