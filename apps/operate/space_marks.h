// SPDX-License-Identifier: Apache-2.0
// Directions and sizes in the 3D view.
#pragma once

#include "apps/operate/console.h"
#include "apps/operate/view_port.h"
#include "engine/contact/host_fixtures.h"
#include "engine/types/sphere_tree.h"

#include <span>

namespace fathom::operate {

// What the 3D view looks at. Base frame [m].
struct SpaceBounds {
    dvec3 middle{0.0};  // of regions and arm; without regions, the median depth on the camera's axis
    double floor = 0.0; // y of the grid, below the regions (y points down)
};
SpaceBounds boundsOf(const HostFixtures& set, std::span<const Sphere> arm);

// Standard directions of the eye; the distance stays. Reset also restores the distance.
enum class Side { Front, Right, Top, Reset };
void lookFrom(Orbit& orbit, Side side);

// The base frame's axes in the lower left corner of the view.
// large: above the hint and inside the frame of the large view.
void drawAxes(ImDrawList& list, const ViewPort& port, bool large);
// A length of 1, 2 or 5 times a power of ten, at the distance [m] of the point that the eye looks at.
void drawScaleBar(ImDrawList& list, const ViewPort& port, double distance);

} // namespace fathom::operate
