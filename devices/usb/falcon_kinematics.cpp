// SPDX-License-Identifier: Apache-2.0
#include "devices/usb/falcon_kinematics.h"

#include "engine/types/angle.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

namespace fathom {

namespace {

// Lengths [m] in Stamper's letters; d = e.
constexpr double kA = 0.060, kB = 0.1025, kC = 0.01443, kDE = 2 * 0.01125, kF = -0.025, kR = 0.0400,
                 kS = -0.02309;
constexpr double kLegs[3] = {105.0 * kDegree, -15.0 * kDegree, -135.0 * kDegree}; // 90, -30, -150, all + 15
constexpr double kPerCount = 0.01425 * 360.0 / (320.0 * 4.0 * 0.110) * kDegree;   // [rad]
constexpr double kAtZero = 35.0 * kDegree;
constexpr int kMaxSteps = 30;
constexpr double kClose = 1e-9;   // [m]
constexpr double kFarthest = 0.1; // [m] from home: farther solutions belong to other assembly modes

// One leg at one knob position: in the plane of its driven joint, the length L of the projected
// parallelogram must span from the elbow to (u, w).
struct Leg {
    double u = 0.0, w = 0.0, length = 0.0; // [m]; length NaN when out of reach sideways
    dvec3 gradU{0.0}, gradLength{0.0};     // by the knob's position

    Leg(const dvec3& p, double phi) noexcept {
        const double c = std::cos(phi), s = std::sin(phi);
        u = c * p.x + s * p.y - kR + kC;
        w = p.z;
        const double v = -s * p.x + c * p.y - kS + kF;
        const double across = std::sqrt(kB * kB - v * v);
        length = kDE + across;
        gradU = {c, s, 0.0};
        gradLength = dvec3(-s, c, 0.0) * (-v / across);
    }
};

// G(p, theta) = |(u, w) - elbow|^2 - L^2 = 0 closes the leg.
struct Closure {
    double g = 0.0, byTheta = 0.0;
    dvec3 byKnob{0.0};

    Closure(const Leg& leg, double theta) noexcept {
        const double c = std::cos(theta), s = std::sin(theta);
        const double du = leg.u - kA * c, dw = leg.w - kA * s;
        g = du * du + dw * dw - leg.length * leg.length;
        byTheta = 2.0 * kA * (du * s - dw * c);
        byKnob = 2.0 * (du * leg.gradU + dvec3(0.0, 0.0, dw) - leg.length * leg.gradLength);
    }
};

} // namespace

LegAngles FalconKinematics::anglesOf(const std::array<int16_t, 3>& encoder) noexcept {
    LegAngles angles{};
    std::transform(encoder.begin(), encoder.end(), angles.begin(),
                   [](int16_t counts) { return kAtZero + kPerCount * counts; });
    return angles;
}

std::array<int16_t, 3> FalconKinematics::encoderOf(const LegAngles& angles) noexcept {
    std::array<int16_t, 3> counts{};
    std::transform(angles.begin(), angles.end(), counts.begin(), [](double theta) {
        return static_cast<int16_t>(
            std::clamp(std::nearbyint((theta - kAtZero) / kPerCount), -32768.0, 32767.0));
    });
    return counts;
}

std::optional<LegAngles> FalconKinematics::inverse(const dvec3& knob) noexcept {
    LegAngles angles{};
    for (size_t i = 0; i < 3; ++i) {
        const Leg leg(knob, kLegs[i]);
        const double reach = std::hypot(leg.u, leg.w);
        // u cos + w sin = (u^2 + w^2 + a^2 - L^2) / 2a; of the two elbows the outer one.
        const double x = (reach * reach + kA * kA - leg.length * leg.length) / (2.0 * kA * reach);
        if (!(std::abs(x) <= 1.0)) {
            return std::nullopt;
        }
        angles[i] = std::atan2(leg.w, leg.u) - std::acos(x);
    }
    return angles;
}

std::optional<dvec3> FalconKinematics::forward(const LegAngles& angles, const dvec3& guess) noexcept {
    dvec3 p = guess;
    for (int step = 0; step < kMaxSteps; ++step) {
        dvec3 g(0.0);
        glm::dmat3 rows(0.0); // column i: gradient of leg i
        for (int i = 0; i < 3; ++i) {
            const Closure closure(Leg(p, kLegs[i]), angles[static_cast<size_t>(i)]);
            g[i] = closure.g;
            rows[i] = closure.byKnob;
        }
        const glm::dmat3 matrix = glm::transpose(rows);
        const double determinant = glm::determinant(matrix);
        if (!(std::abs(determinant) > 1e-9)) {
            return std::nullopt;
        }
        const dvec3 change = glm::inverse(matrix) * g;
        p -= change;
        if (!isFinite(p)) {
            return std::nullopt;
        }
        if (glm::length(change) < kClose) {
            return glm::distance(p, kHome) < kFarthest ? std::optional(p) : std::nullopt;
        }
    }
    return std::nullopt;
}

std::optional<std::array<double, 3>> FalconKinematics::torques(const dvec3& knob, const LegAngles& angles,
                                                               const dvec3& force) noexcept {
    // Rows T_i = dtheta_i/dp; dp = T^-1 dtheta, so that tau = T^-T f: solve T^T tau = f.
    glm::dmat3 transposed(0.0); // column i is T_i
    for (int i = 0; i < 3; ++i) {
        const Closure closure(Leg(knob, kLegs[i]), angles[static_cast<size_t>(i)]);
        if (!(std::abs(closure.byTheta) > 1e-6)) {
            return std::nullopt;
        }
        transposed[i] = -closure.byKnob / closure.byTheta;
    }
    if (!(std::abs(glm::determinant(transposed)) > 1.0)) {
        return std::nullopt;
    }
    const dvec3 tau = glm::inverse(transposed) * force;
    return isFinite(tau) ? std::optional(std::array{tau.x, tau.y, tau.z}) : std::nullopt;
}

} // namespace fathom
