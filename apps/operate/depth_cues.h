// SPDX-License-Identifier: Apache-2.0
// Depth and distance in the views: tether to the nearest region, gap bar, the tool dotted where it is hidden,
// its shadow.
#pragma once

#include "apps/operate/console.h"
#include "apps/operate/nearest.h"
#include "apps/operate/theme.h"
#include "apps/operate/view_port.h"

#include <functional>
#include <limits>
#include <string>

namespace fathom::operate {

inline constexpr double kNearGap = 0.05, kCloseGap = 0.01; // [m]

// By distance: white and thin, amber, red and thick.
enum class GapLook { Far, Near, Close };
GapLook lookOf(double gap);
ImU32 gapColour(GapLook look);
const char* gapName(GapLook look); // far, near, close
std::string gapText(double gap);   // "4.2 mm", "38 mm", "1.24 m", "no region", "unknown"

// What the views show of the tool's place. Base frame.
struct DepthCues {
    double gap = std::numeric_limits<double>::quiet_NaN(); // [m]; infinity: there is no region
    std::optional<Nearest> nearest;
    std::vector<Sphere> tool, shadow; // empty while the tool's place is not known
    double hidden = 0.0;              // share of the tool's outline that is hidden in the large view
};

// measured [m]: as in StepRecord::clearance; NaN = use the distance of the nearest pair.
DepthCues depthCues(const HostFixtures& set, std::vector<Sphere> tool, double measured);

// [m] along the axis of a view of the surface at one of its pixels; 0 = unknown.
using SurfaceDepth = std::function<double(glm::dvec2)>;

void drawShadow(ImDrawList& list, const ViewPort& port, const DepthCues& cues);
// The outline of spheres, dotted where a surface is in front of them. Returns the hidden share of it.
double drawBody(ImDrawList& list, const ViewPort& port, std::span<const Sphere> spheres,
                const SurfaceDepth& surface, ImU32 colour, float width);
// The line to the nearest region, and with `label` its length in words. Returns the plate of the words; empty
// where there are none.
ImVec4 drawTether(ImDrawList& list, const ViewPort& port, const DepthCues& cues, bool label);
// From 0 to 200 mm, in the middle of a rectangle of the window.
void drawGapBar(Console& console, const DepthCues& cues, const Fonts& fonts, const PixelRect& place);

} // namespace fathom::operate
