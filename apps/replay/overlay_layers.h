// SPDX-License-Identifier: Apache-2.0
// The layers of overlay.png, lowest first. Each draws itself whole; none knows the others.
#pragma once

#include "apps/replay/image.h"
#include "apps/replay/image_view.h"
#include "apps/replay/overlay_image.h"

namespace fathom::overlay {

constexpr Colour kRegion{0.93, 0.16, 0.14};
constexpr Colour kGuidance{0.25, 0.60, 1.0};
constexpr Colour kTool{1.0, 1.0, 1.0};
constexpr Colour kForce{1.0, 0.76, 0.20};
constexpr Colour kShade{0.03, 0.04, 0.06};

// The picture to draw on, where it shows the base frame, and by how much lines and letters grow with it.
struct Canvas {
    const Image& image;
    const ImageView& view;
    double size; // 1 at a width of 1280 pixels and below
};

bool hasColour(const OverlayInput& input);
void drawCameraImage(const Canvas& canvas, const OverlayInput& input);
void drawRegions(const Canvas& canvas, const Fixtures& set);
void drawGuidance(const Canvas& canvas, const OverlayInput& input);
void drawGuidanceNames(const Canvas& canvas, const OverlayInput& input); // above tool and hand
void drawTool(const Canvas& canvas, const OverlayInput& input);
void drawForce(const Canvas& canvas, const OverlayInput& input);
// Below the picture, from its lower edge on.
void drawCaption(const Canvas& canvas, const OverlayInput& input, double captionHeight);

// Strokes the current path over a dark edge, so that it is seen on any ground.
void strokeOnShade(const Canvas& canvas, Colour colour, double width, bool dashed = false);
// Line from a to b with a head at b; nothing for a length below two pixels.
void arrow(const Canvas& canvas, glm::dvec2 a, glm::dvec2 b, Colour colour, double width);

} // namespace fathom::overlay
