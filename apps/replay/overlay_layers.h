// SPDX-License-Identifier: Apache-2.0
// The layers of overlay.png, in drawing order. Layers are independent of each other.
#pragma once

#include "apps/output/image.h"
#include "apps/output/image_view.h"
#include "apps/output/silhouette.h"
#include "apps/replay/overlay_image.h"

namespace fathom::overlay {

constexpr Colour kRegion{0.93, 0.16, 0.14};
constexpr Colour kGuidance{0.25, 0.60, 1.0};
constexpr Colour kTool{1.0, 1.0, 1.0};
constexpr Colour kForce{1.0, 0.76, 0.20};
constexpr Colour kShade{0.03, 0.04, 0.06};

// The image, its view of the base frame, and the scale of lines and text.
struct Canvas {
    const Image& image;
    const ImageView& view;
    double size; // scale of lines and text; 1 up to a width of 1280 pixels
};

constexpr double kMinArrow = 0.01; // [N] smaller forces have no arrow

// Which marks are inside the image; the legend names only these. A hand that coincides with the tool is not
// seen.
struct SeenLayers {
    bool regions = false, held = false, points = false, guidance = false, tool = false, hand = false,
         force = false;
};
SeenLayers seenLayers(const ImageView& view, const OverlayInput& input);

bool hasColour(const OverlayInput& input);
void drawCameraImage(const Canvas& canvas, const OverlayInput& input);
void drawRegions(const Canvas& canvas, const HostFixtures& set);
void drawGuidance(const Canvas& canvas, const OverlayInput& input);
void drawGuidanceNames(const Canvas& canvas, const OverlayInput& input); // drawn above tool and hand
void drawTool(const Canvas& canvas, const OverlayInput& input);
void drawForce(const Canvas& canvas, const OverlayInput& input);
// The caption is below the camera image.
void drawCaption(const Canvas& canvas, const OverlayInput& input, double captionHeight);

// Adds the lines to the current path.
void tracePath(const Canvas& canvas, const std::vector<OutlineLine>& lines);
// Strokes the current path over a dark edge, so that it is visible on any background.
void strokeOnShade(const Canvas& canvas, Colour colour, double width, bool dashed = false);
// Draws an arrow from a to b, or nothing if it is shorter than two pixels.
void arrow(const Canvas& canvas, glm::dvec2 a, glm::dvec2 b, Colour colour, double width);

} // namespace fathom::overlay
