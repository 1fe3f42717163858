// SPDX-License-Identifier: Apache-2.0
#include "apps/operate/camera_view_image.h"

#include <algorithm>

namespace fathom::operate {

namespace {

constexpr int kMinWidth = 640;
constexpr size_t kMinOutline = 24;    // [pixels]
constexpr int kHatch = 12, kLine = 2; // [pixels] pattern of the regions
constexpr int kUnknownHatch = 9;

struct Tint {
    int r, g, b;
};
constexpr Tint kRegion{237, 41, 36}, kUnknown{196, 202, 255}, kDark{16, 18, 34}, kPicked{40, 220, 235};

// share: of 256
uint32_t blend(uint32_t below, Tint tint, int share) {
    const auto mix = [&](uint32_t shift, int value) {
        const int under = static_cast<int>(below >> shift & 0xffu);
        return static_cast<uint32_t>(under + (value - under) * share / 256) << shift;
    };
    return 0xff000000u | mix(0, tint.r) | mix(8, tint.g) | mix(16, tint.b);
}

uint32_t greyOf(uint16_t depth, double metresPerUnit) {
    const double z = depth * metresPerUnit;
    const auto level = static_cast<uint32_t>(std::clamp(230.0 - 70.0 * z, 40.0, 230.0));
    return 0xff000000u | level << 16 | level << 8 | level;
}

// For each column of the view: the column of the depth image that it shows. With separate cameras the hatch
// ignores parallax: it marks the holes of the depth image.
using Columns = std::vector<uint32_t>;

void enlarge(const uint32_t* from, uint32_t count, int scale, uint32_t* row) {
    if (scale == 1) {
        std::transform(from, from + count, row, [](uint32_t c) { return c | 0xff000000u; });
        return;
    }
    for (uint32_t u = 0; u < count; ++u) {
        row = std::fill_n(row, scale, from[u] | 0xff000000u);
    }
}

void paintGrey(const uint16_t* depth, double metresPerUnit, const Columns& columns, uint32_t* row) {
    std::transform(columns.begin(), columns.end(), row,
                   [&](uint32_t at) { return greyOf(depth[at], metresPerUnit); });
}

// Returns how many pixels are unknown.
size_t hatchUnknown(const uint16_t* depth, int v, const Columns& columns, uint32_t* row) {
    size_t unknown = 0;
    for (size_t u = 0; u < columns.size(); ++u) {
        if (depth[columns[u]] == 0) {
            ++unknown;
            const bool line = (static_cast<int>(u) - v + 9 * 4096) % kUnknownHatch < 3;
            row[u] = blend(row[u], line ? kUnknown : kDark, line ? 150 : 120);
        }
    }
    return unknown;
}

void tintPicked(const uint8_t* picked, int v, const Columns& columns, uint32_t* row) {
    for (size_t u = 0; u < columns.size(); ++u) {
        if (picked[columns[u]] != 0) {
            row[u] = blend(row[u], kPicked, (static_cast<int>(u) + v) % 8 < 4 ? 225 : 120);
        }
    }
}

// The view with half as many pixels in each direction.
ImageView halved(ImageView view) {
    if (view.scale % 2 == 0) {
        view.scale /= 2;
        return view;
    }
    Intrinsics& lens = view.lens;
    lens.width = std::max(1u, lens.width / 2);
    lens.height = std::max(1u, lens.height / 2);
    lens.fx *= 0.5;
    lens.fy *= 0.5;
    lens.cx = 0.5 * lens.cx - 0.25;
    lens.cy = 0.5 * lens.cy - 0.25; // pixel centres are at integers
    return view;
}

// The outline of a mask in an image with `step` times its pixels in each direction.
std::vector<OutlineLine> outlineIn(const std::vector<uint8_t>& mask, const ImageView& view, int step) {
    const size_t least = kMinOutline / static_cast<size_t>(step);
    std::vector<OutlineLine> lines = traceOutline(mask, view.width(), view.height(), least);
    for (OutlineLine& line : lines) {
        for (glm::dvec2& p : line) {
            p *= static_cast<double>(step);
        }
    }
    return lines;
}

} // namespace

void CameraViewImage::compose(const SceneSnapshot& scene, const Selection& selection) {
    const CameraInfo& camera = scene.set.camera;
    const bool coloured = camera.hasColour && scene.colour.size() == camera.colour.pixels();
    view_ = imageView(camera, scene.set.baseTcamera, !coloured, kMinWidth);
    pixels_.resize(static_cast<size_t>(view_.width()) * static_cast<size_t>(view_.height()));
    paintImage(scene, selection);
    paintRegions(scene.set);
}

void CameraViewImage::paintImage(const SceneSnapshot& scene, const Selection& selection) {
    const CameraInfo& camera = scene.set.camera;
    const Intrinsics& lens = view_.lens;
    const bool coloured = scene.colour.size() == lens.pixels();
    const bool known = scene.set.depth.size() == camera.depth.pixels();
    const bool picked = selection.size() == camera.depth.pixels();
    const std::vector<uint16_t> nothing(camera.depth.width);
    Columns columns(static_cast<size_t>(view_.width()));
    for (size_t u = 0; u < columns.size(); ++u) {
        const auto su = static_cast<uint32_t>(u) / static_cast<uint32_t>(view_.scale);
        columns[u] = su * camera.depth.width / lens.width;
    }
    size_t unknown = 0;
    for (int v = 0; v < view_.height(); ++v) {
        const uint32_t sv = static_cast<uint32_t>(v / view_.scale);
        const size_t depthRow = size_t{sv * camera.depth.height / lens.height} * camera.depth.width;
        const uint16_t* depth = known ? scene.set.depth.data() + depthRow : nothing.data();
        uint32_t* row = pixels_.data() + static_cast<size_t>(v) * columns.size();
        if (coloured) {
            enlarge(scene.colour.data() + size_t{sv} * lens.width, lens.width, view_.scale, row);
        } else {
            paintGrey(depth, camera.metresPerUnit, columns, row);
        }
        unknown += hatchUnknown(depth, v, columns, row);
        if (picked) {
            tintPicked(selection.data() + depthRow, v, columns, row);
        }
    }
    unknown_ = static_cast<double>(unknown) / static_cast<double>(std::max<size_t>(1, pixels_.size()));
}

void CameraViewImage::paintRegions(const HostFixtures& set) {
    seen_.clear();
    held_.clear();
    if (set.frame < 0 || set.spheres.size() == 0) {
        return;
    }
    const ImageView maskView = coarse_ ? halved(view_) : view_;
    const RegionMasks masks = regionMasks(maskView, set);
    const int step = coarse_ ? 2 : 1; // pixels per pixel of the masks
    for (int v = 0; v < view_.height(); ++v) {
        const auto first = static_cast<size_t>(std::min(v / step, maskView.height() - 1)) *
                           static_cast<size_t>(maskView.width());
        uint32_t* out = pixels_.data() + static_cast<size_t>(v) * static_cast<size_t>(view_.width());
        for (int m = 0; m < maskView.width(); ++m) {
            const size_t at = first + static_cast<size_t>(m);
            if ((masks.seen[at] | masks.held[at]) == 0) {
                continue;
            }
            const int end = m + 1 == maskView.width() ? view_.width() : (m + 1) * step;
            for (int u = m * step; u < end; ++u) {
                const bool seen = masks.seen[at] != 0;
                const bool line = (seen ? u + v : u - v + 4096) % kHatch < kLine;
                out[u] = blend(out[u], kRegion, seen ? (line ? 128 : 62) : (line ? 96 : 30));
            }
        }
    }
    for (size_t i = 0; i < set.spheres.size(); ++i) { // marks the points inside regions
        const auto p = view_.ofBase(regionCentre(set, i));
        if (p && p->x >= 0.0 && p->y >= 0.0 && p->x < view_.width() && p->y < view_.height()) {
            uint32_t& target = pixels_[static_cast<size_t>(p->y) * static_cast<size_t>(view_.width()) +
                                       static_cast<size_t>(p->x)];
            target = blend(target, {255, 140, 122}, 170);
        }
    }
    seen_ = outlineIn(masks.seen, maskView, step);
    if (masks.anyHeld) {
        held_ = outlineIn(masks.held, maskView, step);
    }
}

} // namespace fathom::operate
