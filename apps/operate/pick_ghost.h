// SPDX-License-Identifier: Apache-2.0
// The regions that a picked colour or a placed shape would make, before it is added.
#pragma once

#include "apps/operate/depth_cues.h"
#include "engine/contact/shapes.h"

#include <span>
#include <string>
#include <vector>

namespace fathom::operate {

// The spheres around the selected points of the depth image (base frame). Of many points only some, close
// enough together that the outline is the same to a few per cent of the radius [m].
std::vector<Sphere> ghostOf(const HostFixtures& set, std::span<const uint8_t> selection, double radius);

// What regions would do at once: "covers the tool: it will be pushed out 12 mm", "covers the target
// 'yellow valve'". tool: spheres in the base frame.
std::vector<std::string> coverWarnings(std::span<const Sphere> ghost, std::span<const Sphere> tool,
                                       std::span<const GuidancePose> targets, const Scene& scene);

// The same for a placed shape; nothing for a line, an axis or a shape that keeps the tool inside.
std::vector<std::string> coverWarnings(const Shape& shape, std::span<const Sphere> tool,
                                       std::span<const GuidancePose> targets, const Scene& scene);

void drawGhost(ImDrawList& list, const ViewPort& port, std::span<const Sphere> ghost);

} // namespace fathom::operate
