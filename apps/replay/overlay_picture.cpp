// SPDX-License-Identifier: Apache-2.0
#include "apps/replay/overlay_picture.h"

#include "apps/replay/overlay_layers.h"
#include "engine/types/error.h"

#include <algorithm>
#include <cmath>

namespace fathom {

void writeOverlay(const std::filesystem::path& file, const OverlayInput& input) {
    constexpr int kLeastWidth = 960;
    const PictureView view =
        pictureView(input.camera, input.baseTcamera, !overlay::hasColour(input), kLeastWidth);
    if (view.width() <= 0 || view.height() <= 0) {
        throw Error(file.string() + ": the camera has no picture size");
    }
    const double size = std::max(1.0, view.width() / 1280.0);
    const int caption = static_cast<int>(std::lround(88.0 * size));
    const Picture picture(view.width(), view.height() + caption, overlay::kShade);
    const overlay::Canvas canvas{picture, view, size};
    overlay::drawCameraPicture(canvas, input);
    cairo_save(picture.cr());
    cairo_rectangle(picture.cr(), 0.0, 0.0, view.width(), view.height());
    cairo_clip(picture.cr());
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
    cairo_restore(picture.cr());
    overlay::drawCaption(canvas, input, caption);
    picture.writePng(file);
}

} // namespace fathom
