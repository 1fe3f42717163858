// SPDX-License-Identifier: Apache-2.0
// Which connected parts of the matching points a pick takes.
#pragma once

#include "engine/contact/host_fixtures.h"
#include "engine/scene/scene.h"

#include <glm/vec2.hpp>
#include <optional>
#include <span>

namespace fathom::operate {

// As the pilot wants it.
struct PartRules {
    bool onlyClicked = true; // one part: the clicked one, or the nearest to the click
    bool noSpecks = true;    // parts of fewer than speckPoints() do not count
};

// 0.01 % of the depth image, at least 8 points.
uint32_t speckPoints(const Intrinsics& lens);

struct PickedParts {
    uint32_t parts = 0, taken = 0, specks = 0; // specks: parts that are too small
    size_t others = 0;                         // points of other parts inside the box of the taken ones
    std::optional<Box> box;                    // around the taken parts [m, base]; none without a rule
};

// selection: one byte per depth pixel, 1 = the gates of a class accept it. Parts are as in `largest_part`;
// edge: filter.edge. Leaves only those points selected that are in the box, as the class with this box will.
// If all parts are specks, the rule about specks does not apply.
PickedParts takeParts(std::span<uint8_t> selection, const HostFixtures& set, glm::uvec2 clicked,
                      const PartRules& rules, double edge);

} // namespace fathom::operate
