// SPDX-License-Identifier: Apache-2.0
// Constant properties of a depth and colour camera: sizes, lenses, registration, depth unit.
#pragma once

#include "engine/types/colour_format.h"
#include "engine/types/pose.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>

namespace fathom {

// How a lens bends the ray (x/z, y/z), r its length.
enum class LensModel : uint8_t {
    Polynomial,       // OpenCV: radial factor (1 + k1 r^2 + k2 r^4 + k3 r^6) / (1 + k4 r^2 + k5 r^4 + k6 r^6)
    ScaledTangential, // the same, with p1 and p2 applied after the radial factor (librealsense)
    Equidistant,      // Kannala-Brandt: angle t (1 + k1 t^2 + k2 t^4 + k3 t^6 + k4 t^8), t = atan(r)
};

// Pinhole lens with distortion, or a fan of beams at equal angles. Pixel (0, 0) is the centre of the first
// pixel; z forward, x right, y down.
struct Intrinsics {
    uint32_t width = 0, height = 0;                // [pixels]
    double fx = 0.0, fy = 0.0, cx = 0.0, cy = 0.0; // [pixels]
    std::array<double, 5> distortion{};            // k1 k2 p1 p2 k3; Equidistant: k1 k2 k3 k4 -
    // Sonar or laser scanner: (u - cx) / fx is the azimuth from z towards x [rad], (v - cy) / fy the
    // elevation towards y. fx, fy in [pixels/rad]; no distortion; all rays within 85 degrees of the axis.
    bool fan = false;
    LensModel model = LensModel::Polynomial;
    std::array<double, 3> divisor{}; // k4 k5 k6; all zero = Brown-Conrady

    // Polynomial with all coefficients zero: no distortion.
    bool distorted() const {
        return model == LensModel::Equidistant || distortion != std::array<double, 5>{} ||
               divisor != std::array<double, 3>{};
    }
    bool pinhole() const { return !fan && !distorted(); } // a ray is linear in the pixel
    uint32_t pixels() const { return width * height; }

    // Ray (x/z, y/z) through pixel (u, v). Inverts the distortion by iteration in float64.
    glm::dvec2 ray(double u, double v) const noexcept;
    // Pixel of a point with z > 0, distortion included; both kUnseen for a point beyond reach().
    glm::dvec2 project(const dvec3& point) const noexcept;
    // Largest length of a ray (x/z, y/z), at most `most`, up to which a longer ray shows farther from the
    // centre. Beyond it the polynomials of a lens fold the image: they map points far outside it into it.
    double reach(double most = kMaxSlope) const noexcept;
    // Whether ray() inverts project() over the whole image: false when the lens folds the image, or sees
    // farther than 85 degrees from its axis.
    bool invertible() const noexcept;

    static constexpr double kMaxSlope = 11.43; // tan(85 degrees)
    static constexpr double kUnseen = -1e9;    // [pixels]
};

// Uncertainty of a point from a sensor that measures along beams (sonar, laser): a normal error along the
// beam's axis and a uniform one across the beam.
struct BeamSigma {
    double range = 0.0;    // [m] standard deviation along the beam
    double perMetre = 0.0; // [m/m] additional per metre of range
    double width = 0.0;    // [rad] full angle of the beam, 0..1

    // Standard deviation sqrt((range + perMetre r)^2 + (r tan(width / 2))^2 / 3) [m]. The second term is that
    // of a uniform distribution, so 3 sigma exceed the beam's half width.
    double at(double metres) const noexcept;
    double across() const noexcept; // tan(width / 2) / sqrt(3)
};

struct CameraInfo {
    Intrinsics depth;
    Intrinsics colour;            // equal to depth when registered
    bool registered = true;       // colour pixel (u, v) shows the same ray as depth pixel (u, v)
    Pose colourTdepth;            // maps depth-camera points to the colour camera; identity when registered
    double metresPerUnit = 0.001; // depth value 1 in metres; depth value 0 = no measurement
    bool hasColour = true;
    ColourFormat colourFormat = ColourFormat::Rgba;
    double sigma = 0.0;    // [m] systematic error of points that a correction leaves; regions grow by 3 sigma
    bool poseless = false; // no frame has a pose
    uint32_t decimation = 1;       // images are every nth column and row of the camera's
    bool inWater = false;          // depth is already corrected for a flat port; sigma is the remaining error
    std::optional<BeamSigma> beam; // per-point uncertainty; each sphere grows by 3 sigma

    // [bytes] of one frame's colour, at most
    uint64_t colourBytes() const { return mostColourBytes(colourFormat, colour.width, colour.height); }
    // Pixels of memory with room for either image, at 4 bytes per pixel of colour.
    uint32_t slotPixels() const {
        return std::max(depth.pixels(), hasColour ? static_cast<uint32_t>((colourBytes() + 3) / 4) : 0u);
    }
    double sigmaAt(const dvec3& point) const noexcept; // [m] of a reading at this point, camera frame
};

// Standard deviation of a depth reading at range z [m], [m]: the model of structured-light and stereo cameras
// (constant + quadratic). Measured on the D435 recordings: 0.48 mm at 0.38 m on a wheel, 3.75 mm median of
// the frame.
inline double depthSigma(double z) noexcept {
    return 0.0005 + 0.0025 * z * z;
}

} // namespace fathom
