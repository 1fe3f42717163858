// SPDX-License-Identifier: Apache-2.0
#include "engine/types/flat_port.h"

#include "engine/types/error.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace fathom {

namespace {

constexpr double kSteepest = 1.7321; // slope in air: 120 degrees in all
constexpr int kSamples = 200;

// d waterSlope / d air.
double waterSlopeRate(const FlatPort& port, double air) {
    const double n2 = port.index * port.index;
    const double under = n2 + (n2 - 1.0) * air * air;
    return n2 / (under * std::sqrt(under));
}

// Slope from the lens's centre to the point at z on the ray of slope `air`.
double slopeTo(const FlatPort& port, double air, double z) {
    const double water = waterSlope(port, air);
    return water + port.distance * (air - water) / z;
}

// The z at which near and far are off alike: their errors sideways, d (air - water) |1 - z / z0|.
double middleZ(double nearZ, double farZ) {
    return 0.5 * (nearZ + farZ);
}

// k1 k2 k3 with air / index = s (1 + k1 s^2 + k2 s^4 + k3 s^6) for s = slopeTo(air), by least squares.
std::array<double, 3> fitRadial(const FlatPort& port, double scale, double most, double z) {
    double m[3][4] = {};
    for (int i = 1; i <= kSamples; ++i) {
        const double air = most * i / kSamples, s = slopeTo(port, air, z), missing = air / scale - s;
        const double columns[3] = {s * s * s, s * s * s * s * s, s * s * s * s * s * s * s};
        for (int r = 0; r < 3; ++r) {
            for (int c = 0; c < 3; ++c) {
                m[r][c] += columns[r] * columns[c];
            }
            m[r][3] += columns[r] * missing;
        }
    }
    for (int c = 0; c < 3; ++c) { // positive definite: no pivots
        for (int r = 0; r < 3; ++r) {
            const double factor = r == c ? 0.0 : m[r][c] / m[c][c];
            for (int i = c; i < 4; ++i) {
                m[r][i] -= factor * m[c][i];
            }
        }
    }
    return {m[0][3] / m[0][0], m[1][3] / m[1][1], m[2][3] / m[2][2]};
}

// z that stereo along x measures for a true z: the inverse of the change of the ray's slope per unit of x.
double measuredZ(const FlatPort& port, double air, double cosine2, double z) {
    const double beyond = z - port.distance;
    const double along = port.distance + beyond * waterSlopeRate(port, air);
    const double across =
        port.distance + beyond * (air > 1e-9 ? waterSlope(port, air) / air : waterSlopeRate(port, 0.0));
    return 1.0 / (cosine2 / along + (1.0 - cosine2) / across);
}

} // namespace

double waterSlope(const FlatPort& port, double air) noexcept {
    const double n2 = port.index * port.index;
    return air / std::sqrt(n2 + (n2 - 1.0) * air * air);
}

WaterLens inWater(const Intrinsics& air, const FlatPort& port, double nearZ, double farZ) {
    double most = 0.0;
    for (const double u : {0.0, air.width - 1.0}) {
        for (const double v : {0.0, air.height - 1.0}) {
            most = std::max(most, glm::length(air.ray(u, v)));
        }
    }
    if (!(most > 0.0) || most > kSteepest) {
        throw Error("the field of view is too wide for a flat port");
    }
    WaterLens water;
    water.lens = air;
    const double z0 = middleZ(nearZ, farZ);
    // Paraxial: air = scale x slope.
    const double scale = 1.0 / (1.0 / port.index + port.distance * (1.0 - 1.0 / port.index) / z0);
    water.lens.fx = air.fx * scale;
    water.lens.fy = air.fy * scale;
    const auto [k1, k2, k3] = fitRadial(port, scale, most, z0);
    water.lens.distortion = {k1, k2, 0.0, 0.0, k3};
    water.factor.resize(air.pixels());
    const double middle = z0 - port.distance;
    for (uint32_t i = 0; i < air.pixels(); ++i) {
        const uint32_t column = i % air.width, row = i / air.width;
        const glm::dvec2 ray = air.ray(column, row);
        const double slope = glm::length(ray), cosine2 = slope > 1e-9 ? ray.x * ray.x / (slope * slope) : 1.0;
        const double factor = middle / (measuredZ(port, slope, cosine2, z0) - port.distance);
        water.factor[i] = static_cast<float>(factor);
        if (i % 7 != 0 && i + 1 != air.pixels()) {
            continue; // smooth errors: every seventh pixel suffices
        }
        const double used = glm::length(water.lens.ray(column, row));
        for (const double z : {nearZ, farZ}) {
            const double found =
                port.distance + factor * (measuredZ(port, slope, cosine2, z) - port.distance);
            const double sideways = used * found - slopeTo(port, slope, z) * z;
            water.worst = std::max(water.worst, std::hypot(sideways, found - z));
        }
    }
    return water;
}

PortCorrection::PortCorrection(const FlatPort& port, CameraInfo& camera, double nearZ, double farZ,
                               const std::string& name) {
    if (!camera.depth.pinhole() || (camera.hasColour && !camera.colour.pinhole())) {
        throw BadInput(name, "camera.port", "a lens with distortion",
                       "images without lens distortion, or intrinsics calibrated in water and no port");
    }
    try {
        WaterLens depth = inWater(camera.depth, port, nearZ, farZ);
        const bool own = camera.hasColour && !camera.registered;
        camera.colour = own ? inWater(camera.colour, port, nearZ, farZ).lens : depth.lens;
        camera.depth = depth.lens;
        camera.sigma = std::hypot(camera.sigma, depth.worst / 3.0);
        camera.inWater = true;
        factor_ = std::move(depth.factor);
    } catch (const BadInput&) {
        throw;
    } catch (const Error& e) {
        throw BadInput(name, "camera.port", e.what(), "at most 120 degrees in air");
    }
    distance_ = static_cast<float>(port.distance / camera.metresPerUnit);
}

void PortCorrection::apply(std::span<const uint16_t> in, std::span<uint16_t> out) const noexcept {
    for (size_t i = 0; i < factor_.size(); ++i) {
        const float z = distance_ + factor_[i] * (static_cast<float>(in[i]) - distance_);
        out[i] = in[i] == 0 ? uint16_t{0} : static_cast<uint16_t>(std::clamp(z + 0.5f, 1.0f, 65535.0f));
    }
}

} // namespace fathom
