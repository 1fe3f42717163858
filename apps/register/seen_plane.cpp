// SPDX-License-Identifier: Apache-2.0
#include "apps/register/seen_plane.h"

#include "engine/types/colour_copy.h"

#include <Eigen/Eigenvalues>
#include <cmath>
#include <glm/geometric.hpp>

namespace fathom {

namespace {

constexpr size_t kMinPixels = 50;
constexpr double kMaxOffPlane = 0.01; // of the distance

struct Plane {
    dvec3 point{0.0}, normal{0.0};
};

std::optional<Plane> fitPlane(const std::vector<dvec3>& points) {
    if (points.size() < kMinPixels) {
        return std::nullopt;
    }
    dvec3 mean(0.0);
    for (const dvec3& p : points) {
        mean += p / static_cast<double>(points.size());
    }
    Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
    for (const dvec3& p : points) {
        const Eigen::Vector3d d(p.x - mean.x, p.y - mean.y, p.z - mean.z);
        spread += d * d.transpose() / static_cast<double>(points.size());
    }
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> shape(spread);
    if (std::sqrt(std::max(0.0, shape.eigenvalues()(0))) > kMaxOffPlane * mean.z) {
        return std::nullopt;
    }
    const Eigen::Vector3d n = shape.eigenvectors().col(0);
    return Plane{mean, {n(0), n(1), n(2)}};
}

bool holds(const std::array<glm::dvec2, 4>& corners, const glm::dvec2& p) {
    int left = 0;
    for (size_t i = 0; i < 4; ++i) {
        const glm::dvec2 edge = corners[(i + 1) % 4] - corners[i], to = p - corners[i];
        left += edge.x * to.y - edge.y * to.x > 0.0 ? 1 : 0;
    }
    return left == 0 || left == 4;
}

// Depth points that project inside the outline of the colour image, in the colour camera's frame.
std::vector<dvec3> depthInside(const Frame& frame, const CameraInfo& camera,
                               const std::array<glm::dvec2, 4>& outline) {
    std::vector<dvec3> points;
    for (uint32_t i = 0; i < frame->depth.size(); ++i) {
        if (frame->depth[i] == 0) {
            continue;
        }
        const uint32_t row = i / camera.depth.width;
        const glm::dvec2 ray = camera.depth.ray(i % camera.depth.width, row);
        const double z = frame->depth[i] * camera.metresPerUnit;
        const Pose& pose = camera.colourTdepth;
        const dvec3 p = pose.rotation * dvec3(ray.x * z, ray.y * z, z) + pose.position;
        if (p.z > 0.0 && holds(outline, camera.colour.project(p))) {
            points.push_back(p);
        }
    }
    return points;
}

} // namespace

void greyOf(const Frame& frame, std::vector<uint8_t>& grey) {
    std::vector<uint32_t> rgba;
    readColours(*frame, rgba);
    grey.resize(rgba.size());
    for (size_t i = 0; i < grey.size(); ++i) {
        const uint32_t c = rgba[i];
        grey[i] = static_cast<uint8_t>((77 * (c & 255) + 150 * (c >> 8 & 255) + 29 * (c >> 16 & 255)) >> 8);
    }
}

std::optional<SeenPlane> SeenPlane::inside(const Frame& frame, const CameraInfo& camera,
                                           const std::array<glm::dvec2, 4>& outline) {
    const std::optional<Plane> plane = fitPlane(depthInside(frame, camera, outline));
    if (!plane) {
        return std::nullopt;
    }
    SeenPlane seen;
    seen.camera_ = camera;
    seen.point_ = plane->point;
    seen.normal_ = plane->normal;
    return seen;
}

dvec3 SeenPlane::at(const glm::dvec2& colourPixel) const {
    const dvec3 ray(camera_.colour.ray(colourPixel.x, colourPixel.y), 1.0);
    const dvec3 seen = ray * (glm::dot(point_, normal_) / glm::dot(ray, normal_));
    const Pose depthTcolour = inverse(camera_.colourTdepth);
    return depthTcolour.rotation * seen + depthTcolour.position;
}

} // namespace fathom
