// SPDX-License-Identifier: Apache-2.0
#include "apps/operate/space_marks.h"

#include "apps/operate/theme.h"
#include "apps/output/silhouette.h"
#include "engine/types/angle.h"
#include "engine/types/median.h"
#include "engine/types/printed.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace fathom::operate {

namespace {

constexpr double kBelow = 0.02; // [m] of the grid under the lowest region

// The median depth of the camera on its axis.
dvec3 middleOfDepth(const HostFixtures& set) {
    std::vector<uint16_t> near;
    for (size_t i = 0; i < set.depth.size(); i += 37) {
        if (set.depth[i] != 0) {
            near.push_back(set.depth[i]);
        }
    }
    if (near.empty()) {
        return {0.0, 0.0, 1.0};
    }
    return set.baseTcamera.apply({0.0, 0.0, medianOf(near) * set.camera.metresPerUnit});
}

} // namespace

SpaceBounds boundsOf(const HostFixtures& set, std::span<const Sphere> arm) {
    if (set.spheres.size() == 0) {
        const dvec3 middle = middleOfDepth(set);
        return {middle, middle.y + 0.2};
    }
    dvec3 low(1e300), high(-1e300);
    for (size_t i = 0; i < set.spheres.size(); ++i) {
        low = glm::min(low, regionCentre(set, i));
        high = glm::max(high, regionCentre(set, i));
    }
    const double radius = double{*std::max_element(set.spheres.radius.begin(), set.spheres.radius.end())};
    const double floor = high.y + radius + kBelow;
    for (const Sphere& s : arm) {
        low = glm::min(low, s.centre);
        high = glm::max(high, s.centre);
    }
    return {0.5 * (low + high), floor};
}

void lookFrom(Orbit& orbit, Side side) {
    constexpr double kQuarter = 0.25 * kTurn;
    const Orbit fresh;
    orbit.yaw = side == Side::Right ? kQuarter : side == Side::Reset ? fresh.yaw : 0.0;
    orbit.pitch = side == Side::Top ? kQuarter : side == Side::Reset ? fresh.pitch : 0.0;
    orbit.distance = side == Side::Reset ? fresh.distance : orbit.distance;
}

void drawAxes(ImDrawList& list, const ViewPort& port, bool large) {
    constexpr ImU32 kColours[] = {IM_COL32(255, 120, 110, 255), IM_COL32(120, 220, 130, 255),
                                  IM_COL32(120, 170, 255, 255)};
    constexpr const char* kNames[] = {"x", "y", "z"};
    const float line = ImGui::GetTextLineHeight(), length = (large ? 2.0f : 1.4f) * line;
    const ImVec2 at{static_cast<float>(port.where.x) + (large ? 4.2f : 2.4f) * line,
                    static_cast<float>(port.where.y + port.where.height) - (large ? 7.4f : 2.4f) * line};
    list.AddCircleFilled(at, 1.45f * length, colour::kShade, 32);
    for (int axis = 0; axis < 3; ++axis) {
        dvec3 along(0.0);
        along[axis] = 1.0;
        along = port.view.cameraTbase.rotation * along;
        const ImVec2 end{at.x + length * static_cast<float>(along.x),
                         at.y + length * static_cast<float>(along.y)};
        list.AddLine(at, end, kColours[axis], 2.2f);
        const ImVec2 name = ImGui::CalcTextSize(kNames[axis]);
        const ImVec2 place{at.x + 1.25f * (end.x - at.x), at.y + 1.25f * (end.y - at.y)};
        list.AddText({place.x - 0.5f * name.x, place.y - 0.5f * name.y}, kColours[axis], kNames[axis]);
    }
}

void drawScaleBar(ImDrawList& list, const ViewPort& port, double distance) {
    const double metresPerPixel = port.metresPerPixel(distance),
                 longest = 0.22 * port.where.width * metresPerPixel;
    double length = std::pow(10.0, std::floor(std::log10(longest)));
    length *= 5.0 * length <= longest ? 5.0 : 2.0 * length <= longest ? 2.0 : 1.0;
    const std::string text = length < 1.0 ? printed("%.0f mm", 1e3 * length) : printed("%.0f m", length);
    const float line = ImGui::GetTextLineHeight(), pixels = static_cast<float>(length / metresPerPixel);
    // A large view has the stop plate at its right.
    const float right = static_cast<float>(port.where.width) > 40.0f * line ? 12.0f : 2.0f; // [lines]
    const ImVec2 b{static_cast<float>(port.where.x + port.where.width) - right * line,
                   static_cast<float>(port.where.y + port.where.height) - 2.6f * line};
    const ImVec2 a{b.x - pixels, b.y};
    for (const auto& [c, w] : {std::pair(colour::kShade, 4.6f), std::pair(colour::kText, 2.0f)}) {
        list.AddLine(a, b, c, w);
        list.AddLine({a.x, a.y - 5.0f}, {a.x, a.y + 5.0f}, c, w);
        list.AddLine({b.x, b.y - 5.0f}, {b.x, b.y + 5.0f}, c, w);
    }
    const ImVec2 words = ImGui::CalcTextSize(text.c_str());
    list.AddText({0.5f * (a.x + b.x - words.x), a.y - words.y - 4.0f}, colour::kText, text.c_str());
}

} // namespace fathom::operate
