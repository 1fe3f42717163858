// SPDX-License-Identifier: Apache-2.0
#include "engine/cloud/guidance_pose.h"

#include <algorithm>
#include <cmath>
#include <glm/mat3x3.hpp>

namespace fathom::cloud {

namespace {

constexpr double kPlaneThickness = 0.003; // [m]
constexpr double kPlaneRatio = 0.1;
constexpr double kPlaneWidth = 0.005; // [m]
constexpr double kLongAxis = 2.0;

// Rotates rows and columns p, q so that a[p][q] becomes zero (Golub and Van Loan 8.4).
// Not jacobi.h, which skips tiny a[p][q]: guidance must stay bit-equal.
void jacobiRotate(double (&a)[3][3], double (&v)[3][3], int p, int q) noexcept {
    if (a[p][q] == 0.0) {
        return;
    }
    const double theta = (a[q][q] - a[p][p]) / (2.0 * a[p][q]);
    const double t = (theta >= 0.0 ? 1.0 : -1.0) / (std::abs(theta) + std::sqrt(theta * theta + 1.0));
    const double c = 1.0 / std::sqrt(t * t + 1.0), s = t * c;
    for (int k = 0; k < 3; ++k) {
        const double kp = a[k][p], kq = a[k][q];
        a[k][p] = c * kp - s * kq;
        a[k][q] = s * kp + c * kq;
    }
    for (int k = 0; k < 3; ++k) {
        const double pk = a[p][k], qk = a[q][k];
        a[p][k] = c * pk - s * qk;
        a[q][k] = s * pk + c * qk;
        const double vp = v[k][p], vq = v[k][q];
        v[k][p] = c * vp - s * vq;
        v[k][q] = s * vp + c * vq;
    }
}

// Tool axes: +z along -normal; +x along the long axis of the points or, without one, as near to the scene's x
// as possible.
dquat targetRotation(const dvec3& normal, const dvec3& longAxis, bool rollFree, const dquat& scene) {
    const dvec3 z = -normal;
    const dvec3 sceneX = scene * dvec3(1, 0, 0);
    dvec3 x = rollFree ? sceneX : (glm::dot(longAxis, sceneX) < 0.0 ? -longAxis : longAxis);
    x -= glm::dot(x, z) * z;
    if (glm::length(x) < 1e-6) { // the scene's x is parallel to the normal: use its y
        x = scene * dvec3(0, 1, 0);
        x -= glm::dot(x, z) * z;
    }
    x = glm::normalize(x);
    return glm::normalize(glm::quat_cast(glm::dmat3(x, glm::cross(z, x), z)));
}

} // namespace

Moments merge(const Moments& a, const Moments& b) noexcept {
    if (a.count == 0.0 || b.count == 0.0) {
        return a.count == 0.0 ? b : a;
    }
    Moments m;
    m.count = a.count + b.count;
    const dvec3 d = b.mean - a.mean;
    const double w = a.count * b.count / m.count;
    m.mean = a.mean + d * (b.count / m.count);
    const std::array<double, 6> outer{d.x * d.x, d.x * d.y, d.x * d.z, d.y * d.y, d.y * d.z, d.z * d.z};
    for (size_t i = 0; i < 6; ++i) {
        m.products[i] = a.products[i] + b.products[i] + w * outer[i];
    }
    return m;
}

Moments mergeAll(std::vector<Moments> parts) {
    if (parts.empty()) {
        return {};
    }
    for (size_t step = 1; step < parts.size(); step *= 2) {
        for (size_t i = 0; i + step < parts.size(); i += 2 * step) {
            parts[i] = merge(parts[i], parts[i + step]);
        }
    }
    return parts[0];
}

Moments momentsOf(std::span<const dvec3> points) {
    Moments m;
    if (points.empty()) {
        return m;
    }
    m.count = static_cast<double>(points.size());
    dvec3 sum(0.0); // relative to the first point: a small set far away loses no digits
    for (const dvec3& p : points) {
        sum += p - points[0];
    }
    m.mean = points[0] + sum / m.count;
    for (const dvec3& p : points) {
        const dvec3 d = p - m.mean;
        const std::array<double, 6> outer{d.x * d.x, d.x * d.y, d.x * d.z, d.y * d.y, d.y * d.z, d.z * d.z};
        for (size_t i = 0; i < 6; ++i) {
            m.products[i] += outer[i];
        }
    }
    return m;
}

Eigen3 symmetricEigen(const std::array<double, 6>& m) noexcept {
    double a[3][3] = {{m[0], m[1], m[2]}, {m[1], m[3], m[4]}, {m[2], m[4], m[5]}};
    double v[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    for (int sweep = 0; sweep < 12;
         ++sweep) { // quadratic convergence: 4 to 6 sweeps suffice, also for near-equal eigenvalues
        jacobiRotate(a, v, 0, 1);
        jacobiRotate(a, v, 0, 2);
        jacobiRotate(a, v, 1, 2);
    }
    std::array<int, 3> order{0, 1, 2};
    std::stable_sort(order.begin(), order.end(), [&](int i, int j) { return a[i][i] > a[j][j]; });
    Eigen3 result;
    for (int k = 0; k < 3; ++k) {
        result.values[k] = a[order[k]][order[k]];
        result.vectors[static_cast<size_t>(k)] = {v[0][order[k]], v[1][order[k]], v[2][order[k]]};
    }
    return result;
}

GuidancePose guidancePose(const Moments& moments, const FixtureClass& fixture, uint32_t row,
                          const dvec3& camera) {
    GuidancePose pose;
    pose.fixture = row;
    pose.count = static_cast<uint32_t>(moments.count);
    pose.present = pose.count >= std::max(1u, fixture.minCount);
    pose.position = moments.mean;
    const dvec3 away = camera - moments.mean;
    const dvec3 toCamera = glm::length(away) > 0.0 ? glm::normalize(away) : dvec3(0, 0, -1);
    dvec3 standoffAxis = toCamera;
    pose.target.rotation = fixture.orientation;
    if (pose.count >= 3) {
        std::array<double, 6> covariance = moments.products;
        for (double& c : covariance) {
            c /= moments.count;
        }
        const Eigen3 e = symmetricEigen(covariance);
        const double l1 = std::max(e.values.x, 0.0), l2 = std::max(e.values.y, 0.0),
                     l3 = std::max(e.values.z, 0.0);
        pose.planar = std::sqrt(l3) <= std::max(kPlaneThickness, kPlaneRatio * std::sqrt(l2)) &&
                      std::sqrt(l2) >= kPlaneWidth;
        if (pose.planar) {
            pose.normal = glm::dot(e.vectors[2], toCamera) < 0.0 ? -e.vectors[2] : e.vectors[2];
            pose.rollFree = !(l1 > kLongAxis * l2);
            pose.target.rotation =
                targetRotation(pose.normal, e.vectors[0], pose.rollFree, fixture.orientation);
            standoffAxis = pose.normal;
        }
    }
    pose.standoff = fixture.standoff * standoffAxis;
    pose.target.position = pose.position + pose.standoff;
    return pose;
}

} // namespace fathom::cloud
