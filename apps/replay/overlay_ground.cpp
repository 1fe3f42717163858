// SPDX-License-Identifier: Apache-2.0
// The background of overlay.png: the colour image, or the depth image in grey.
#include "apps/replay/overlay_layers.h"

#include <algorithm>
#include <cmath>
#include <memory>

namespace fathom::overlay {

namespace {

constexpr uint32_t kNothing = 0xff10141au; // 0xAARRGGBB for pixels without depth, or without any image

uint32_t fromColour(uint32_t abgr) {
    return 0xff000000u | (abgr & 0xffu) << 16 | (abgr & 0xff00u) | (abgr >> 16 & 0xffu);
}

// Maps the range from the 2nd to the 98th percentile to grey; near is bright.
std::vector<uint32_t> depthAsGrey(std::span<const uint16_t> depth) {
    std::vector<uint16_t> valid;
    std::copy_if(depth.begin(), depth.end(), std::back_inserter(valid), [](uint16_t z) { return z != 0; });
    std::vector<uint32_t> grey(depth.size(), kNothing);
    if (valid.empty()) {
        return grey;
    }
    const auto of = [&valid](size_t perCent) {
        const auto place = valid.begin() + static_cast<std::ptrdiff_t>((valid.size() - 1) * perCent / 100);
        std::nth_element(valid.begin(), place, valid.end());
        return double{static_cast<double>(*place)};
    };
    const double nearest = of(2), farthest = std::max(of(98), nearest + 1.0);
    for (size_t i = 0; i < depth.size(); ++i) {
        if (depth[i] != 0) {
            const double share = std::clamp((depth[i] - nearest) / (farthest - nearest), 0.0, 1.0);
            const auto level = static_cast<uint32_t>(std::lround(205.0 - 160.0 * share));
            grey[i] = 0xff000000u | level << 16 | level << 8 | level;
        }
    }
    return grey;
}

std::vector<uint32_t> groundPixels(const OverlayInput& input, size_t pixels) {
    if (hasColour(input)) {
        std::vector<uint32_t> result(pixels);
        std::transform(input.colour.begin(), input.colour.end(), result.begin(), fromColour);
        return result;
    }
    if (input.depth.size() == pixels) {
        return depthAsGrey(input.depth);
    }
    return std::vector<uint32_t>(pixels, kNothing);
}

} // namespace

bool hasColour(const OverlayInput& input) {
    return input.camera.hasColour && !input.colour.empty() &&
           input.colour.size() == input.camera.colour.pixels();
}

void drawCameraImage(const Canvas& canvas, const OverlayInput& input) {
    const Intrinsics& lens = canvas.view.lens;
    std::vector<uint32_t> pixels = groundPixels(input, lens.pixels());
    const auto width = static_cast<int>(lens.width);
    const std::unique_ptr<cairo_surface_t, void (*)(cairo_surface_t*)> ground(
        cairo_image_surface_create_for_data(reinterpret_cast<unsigned char*>(pixels.data()),
                                            CAIRO_FORMAT_ARGB32, width, static_cast<int>(lens.height),
                                            4 * width),
        cairo_surface_destroy);
    cairo_t* cr = canvas.image.cr();
    cairo_save(cr);
    cairo_rectangle(cr, 0.0, 0.0, canvas.view.width(), canvas.view.height());
    cairo_clip(cr);
    cairo_scale(cr, canvas.view.scale, canvas.view.scale);
    cairo_set_source_surface(cr, ground.get(), 0.0, 0.0);
    cairo_pattern_set_filter(cairo_get_source(cr), CAIRO_FILTER_BILINEAR);
    cairo_pattern_set_extend(cairo_get_source(cr), CAIRO_EXTEND_PAD);
    cairo_paint(cr);
    // Darkens the image slightly, so that lines stand out from bright walls.
    canvas.image.setColour(kShade.alpha(0.16));
    cairo_paint(cr);
    cairo_restore(cr);
    cairo_surface_flush(cairo_get_target(cr));
}

} // namespace fathom::overlay
