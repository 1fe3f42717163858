// SPDX-License-Identifier: Apache-2.0
// Twin of shaders/classify.comp: class bits of every pixel (paper IV.B, with colour, box and range gates).
#pragma once

#include "engine/reference/occlusion.h"

namespace fathom::reference {

// Hexagonal HSL of stored sRGB bytes. Hue in degrees 0..360; grey (max = min) has none.
struct Hsl {
    double hue = 0.0, saturation = 0.0, lightness = 0.0;
    bool grey = false;
};
Hsl hslOf(uint32_t rgba); // 0xAABBGGRR

// What the water between took of a colour given back: linear light is the stored byte to the power of 2.2 and
// falls as exp(-attenuation [1/m] x range [m]). unsure: some byte is within 1e-3 of the next.
struct ClearColour {
    uint32_t rgba = 0;
    bool unsure = false;
};
ClearColour withoutWater(uint32_t rgba, const dvec3& attenuation, double range);

struct ClassImage {
    std::vector<uint32_t> masks;
    std::vector<uint8_t> unsure; // 1: a coordinate, a depth or a frame position lies within 1e-6 m (1e-3
                                 // pixels) of its threshold
};

// cells: what the occlusion pass found, nullptr when colour is registered to depth or the camera has none.
// Colour gates are fractions of bytes and never unsure.
ClassImage classify(const FrameView& view, const CellImage* cells);

// Pixels with a depth in near..far.
uint32_t validPixels(const FrameView& view);

} // namespace fathom::reference
