// SPDX-License-Identifier: Apache-2.0
#include "engine/types/decimation.h"

#include <vector>

namespace fathom {

namespace {

void decimateLens(Intrinsics& lens, uint32_t n) {
    lens.width = (lens.width + n - 1) / n, lens.height = (lens.height + n - 1) / n;
    lens.fx /= n, lens.fy /= n, lens.cx /= n, lens.cy /= n;
}

} // namespace

CameraInfo decimated(CameraInfo camera, uint32_t n) {
    if (n == 1) {
        return camera;
    }
    decimateLens(camera.depth, n);
    if (camera.registered) {
        decimateLens(camera.colour, n);
        camera.colourFormat = ColourFormat::Rgba;
    }
    camera.decimation *= n;
    return camera;
}

void decimateColour(const RawColour& image, uint32_t n, std::span<uint32_t> rgba) {
    std::vector<uint32_t> row(image.width);
    size_t next = 0;
    for (uint32_t v = 0; v < image.height; v += n) {
        unpackRow(image, v, row);
        for (uint32_t u = 0; u < image.width; u += n) {
            rgba[next++] = row[u];
        }
    }
}

} // namespace fathom
