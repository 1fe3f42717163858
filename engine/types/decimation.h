// SPDX-License-Identifier: Apache-2.0
// Smaller images: every nth column and row of a camera's. Noise per pixel stays the same.
#pragma once

#include "engine/types/camera_info.h"

#include <cstdint>
#include <span>

namespace fathom {

// Largest n that a scene may ask for.
inline constexpr uint32_t kMaxDecimation = 8;

// The camera when every nth column and row is used, from the first one on. Colour keeps its size if
// it has a lens of its own. Registered colour becomes RGBA, because pixels of other formats share chroma.
CameraInfo decimated(CameraInfo camera, uint32_t n);

// Picks every nth pixel of each nth row. `from`: an image of `lens`; `to`: at least as long as the result,
// may begin where `from` does.
template <class Pixel>
void decimate(std::span<const Pixel> from, const Intrinsics& lens, uint32_t n, std::span<Pixel> to) noexcept {
    size_t next = 0;
    for (uint32_t v = 0; v < lens.height; v += n) {
        for (uint32_t u = 0; u < lens.width; u += n) {
            to[next++] = from[size_t{v} * lens.width + u];
        }
    }
}
// The same of colour in any format, as 0xAABBGGRR.
void decimateColour(const RawColour& image, uint32_t n, std::span<uint32_t> rgba);

} // namespace fathom
