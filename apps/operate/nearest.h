// SPDX-License-Identifier: Apache-2.0
// How far the tool is from what must not be touched, and what lies behind it.
#pragma once

#include "engine/contact/host_fixtures.h"
#include "engine/types/sphere_tree.h"

#include <optional>
#include <span>
#include <vector>

namespace fathom::operate {

// The nearest pair of tool and regions. Base frame [m].
struct Nearest {
    dvec3 from{0.0}, to{0.0}; // on the surfaces of tool and region
    double gap = 0.0;         // negative: they overlap
    uint32_t fixture = 0;     // index into Scene::fixtures
};

// tool: spheres in the base frame. Empty without regions or without a tool. Exact, and fast while most
// regions are far away.
std::optional<Nearest> nearestRegion(const HostFixtures& set, std::span<const Sphere> tool);

// The shadow that the tool would throw on what the depth camera sees, with the light above and left of the
// camera: spheres on the surface (base frame), one for each sphere of the tool, or for each n-th of a large
// one. Spheres whose shadow falls where no surface is seen have none.
std::vector<Sphere> shadowOf(const HostFixtures& set, std::span<const Sphere> tool);

// [m] along the depth camera's axis of the surface at a pixel of it; 0 = no depth there.
double surfaceAt(const HostFixtures& set, double u, double v);

} // namespace fathom::operate
