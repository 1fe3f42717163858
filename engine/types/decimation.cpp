// SPDX-License-Identifier: Apache-2.0
#include "engine/types/decimation.h"

#include "engine/types/yuyv.h"

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
        camera.yuyv = false;
    }
    camera.decimation *= n;
    return camera;
}

void decimateYuyv(std::span<const uint32_t> words, const Intrinsics& lens, uint32_t n,
                  std::span<uint32_t> rgba) noexcept {
    size_t next = 0;
    for (uint32_t v = 0; v < lens.height; v += n) {
        for (uint32_t u = 0; u < lens.width; u += n) {
            const size_t pixel = size_t{v} * lens.width + u;
            rgba[next++] = rgbaOfYuyv(words[pixel / 2])[pixel % 2];
        }
    }
}

} // namespace fathom
