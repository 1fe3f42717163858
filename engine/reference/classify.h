// SPDX-License-Identifier: Apache-2.0
// Twin of shaders/classify.comp: class bits of every pixel (paper IV.B, with colour, box and range gates).
#pragma once

#include "engine/reference/occlusion.h"

namespace fathom::reference {

// Hexagonal HSL of stored sRGB bytes. Hue in degrees 0..360; grey (max = min) has no hue.
struct Hsl {
    double hue = 0.0, saturation = 0.0, lightness = 0.0;
    bool grey = false;
};
Hsl hslOf(uint32_t rgba); // 0xAABBGGRR

// A colour corrected for attenuation in water: linear light is the stored byte to the power of 2.2 and decays
// as exp(-attenuation [1/m] x range [m]). unsure: some byte is within 1e-3 of its rounding threshold.
struct ClearColour {
    uint32_t rgba = 0;
    bool unsure = false;
};
ClearColour withoutWater(uint32_t rgba, const dvec3& attenuation, double range);

struct ClassImage {
    std::vector<uint32_t> masks;
    // 1: a coordinate, depth or image position is within 1e-6 m (1e-3 pixels) of its threshold
    std::vector<uint8_t> unsure;
};

// cells: result of the occlusion pass; nullptr when colour is registered to depth or missing. Colour gates
// compare fractions of bytes and are never unsure.
ClassImage classify(const FrameView& view, const CellImage* cells);

// Number of pixels with a depth in near..far.
uint32_t validPixels(const FrameView& view);

} // namespace fathom::reference
