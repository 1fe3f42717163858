// SPDX-License-Identifier: Apache-2.0
#include "apps/replay/overlay_image.h"

#include "apps/replay/overlay_layers.h"
#include "engine/types/error.h"

#include <algorithm>
#include <cmath>

namespace fathom {

Image drawOverlay(const OverlayInput& input) {
    constexpr int kMinWidth = 960;
    const ImageView view = imageView(input.camera, input.baseTcamera, !overlay::hasColour(input), kMinWidth);
    if (view.width() <= 0 || view.height() <= 0) {
        throw Error("overlay.png: the camera has no image size");
    }
    const double size = std::max(1.0, view.width() / 1280.0);
    const int caption = static_cast<int>(std::lround(88.0 * size));
    Image image(view.width(), view.height() + caption, overlay::kShade);
    const overlay::Canvas canvas{image, view, size};
    overlay::drawCameraImage(canvas, input);
    cairo_save(image.cr());
    cairo_rectangle(image.cr(), 0.0, 0.0, view.width(), view.height());
    cairo_clip(image.cr());
    const bool anySet = input.set != nullptr && input.set->frame >= 0;
    if (anySet) {
        overlay::drawRegions(canvas, *input.set);
        overlay::drawGuidance(canvas, input);
    }
    overlay::drawTool(canvas, input);
    if (anySet) {
        overlay::drawGuidanceNames(canvas, input);
    }
    overlay::drawForce(canvas, input);
    cairo_restore(image.cr());
    overlay::drawCaption(canvas, input, caption);
    return image;
}

} // namespace fathom
