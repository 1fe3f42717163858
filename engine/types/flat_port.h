// SPDX-License-Identifier: Apache-2.0
// A camera behind a flat window under water: the effect of refraction on its rays and its stereo depth. The
// window is parallel to the image plane; the thickness of the glass counts as air.
#pragma once

#include "engine/types/camera_info.h"

#include <span>
#include <string>
#include <vector>

namespace fathom {

struct FlatPort {
    double distance = 0.0; // [m] from the lens's centre of projection to the water
    double index = 1.34;   // of sea water; fresh water 1.33, air 1
};

// Slope (tangent of the angle to the axis) in water of the ray that has slope `air` before the window
// (Snell).
double waterSlope(const FlatPort& port, double air) noexcept;

// The camera model in water, derived from the model in air, for points between nearZ and farZ.
struct WaterLens {
    Intrinsics lens; // rays in water, from the centre of projection, nearest to the true ones
    std::vector<float>
        factor;         // per pixel: true z = distance + factor x (measured z - distance), for stereo along x
    double worst = 0.0; // [m] largest error that is left, sideways and in depth together
};

// A ray in water does not pass through the lens's centre, so one slope per pixel is exact at one z only. That
// z is chosen so that nearZ and farZ have equal errors. Stereo measures z by the angle between two rays: the
// result is too near by about the index, and by more off the axis. The lens's own distortion is removed
// first. Throws Error for a field of view of more than 120 degrees in air, whose rays are too flat for the
// fit.
WaterLens inWater(const Intrinsics& air, const FlatPort& port, double nearZ, double farZ);

// Adapts a camera that was calibrated in air. For stereo and structured light along the image rows; not for
// time of flight. Depth keeps its unit (65535 units are the farthest). A lens's own distortion is that in air
// and is corrected only in the model of the rays, so images must have no distortion. Immutable.
class PortCorrection {
public:
    // Changes the lenses, sigma and inWater of `camera`: what the model leaves wrong between nearZ and farZ
    // is sigma, a third of its largest. name: of the camera, for messages. Throws BadInput for lenses with
    // distortion or too wide a view.
    PortCorrection(const FlatPort& port, CameraInfo& camera, double nearZ, double farZ,
                   const std::string& name);

    // Depth values in water; `out` may be `in`. Both have one value per pixel. 0 stays 0.
    void apply(std::span<const uint16_t> in, std::span<uint16_t> out) const noexcept;

private:
    std::vector<float> factor_;
    float distance_ = 0.0f; // [units]
};

} // namespace fathom
