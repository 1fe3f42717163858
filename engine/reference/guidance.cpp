// SPDX-License-Identifier: Apache-2.0
#include "engine/reference/guidance.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numeric>

namespace fathom::reference {

namespace {

dvec3 fromEigen(const Eigen::Vector3d& v) {
    return {v.x(), v.y(), v.z()};
}

// The rotation with +z along -normal whose +x is nearest to `like`.
dquat facing(const dvec3& normal, const dvec3& like) {
    const Eigen::Vector3d z(-normal.x, -normal.y, -normal.z), x0(like.x, like.y, like.z);
    Eigen::Matrix3d r;
    r.col(2) = z;
    r.col(0) = (x0 - x0.dot(z) * z).normalized();
    r.col(1) = r.col(2).cross(r.col(0));
    const Eigen::Quaterniond q(r);
    return {q.w(), q.x(), q.y(), q.z()};
}

// Disjoint sets of pixels, by index.
class Parts {
public:
    explicit Parts(size_t count)
        : parent_(count) {
        std::iota(parent_.begin(), parent_.end(), size_t{0});
    }
    size_t root(size_t i) {
        while (parent_[i] != i) {
            i = parent_[i] = parent_[parent_[i]];
        }
        return i;
    }
    void join(size_t a, size_t b) {
        const size_t ra = root(a), rb = root(b);
        parent_[std::max(ra, rb)] = std::min(ra, rb);
    }

private:
    std::vector<size_t> parent_;
};

} // namespace

GuidancePose guidance(std::span<const dvec3> points, const FixtureClass& fixture, const dvec3& camera) {
    const PointMoments m = moments(points);
    GuidancePose pose;
    pose.count = static_cast<uint32_t>(points.size());
    pose.present = pose.count >= fixture.minCount && pose.count > 0;
    pose.position = m.mean;
    pose.target.rotation = fixture.orientation;
    const dvec3 toCamera = glm::normalize(camera - m.mean);
    pose.target.position = m.mean + fixture.standoff * toCamera;
    if (pose.count < 3) {
        return pose;
    }
    Eigen::Matrix3d c;
    c << m.covariance[0], m.covariance[1], m.covariance[2], m.covariance[1], m.covariance[3], m.covariance[4],
        m.covariance[2], m.covariance[4], m.covariance[5];
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(c); // eigenvalues in ascending order
    const Eigen::Vector3d sigma = solver.eigenvalues().cwiseMax(0.0).cwiseSqrt();
    pose.planar = sigma(0) <= std::max(0.003, 0.1 * sigma(1)) && sigma(1) >= 0.005;
    if (!pose.planar) {
        return pose;
    }
    pose.normal = fromEigen(solver.eigenvectors().col(0));
    pose.normal *= glm::dot(pose.normal, toCamera) < 0.0 ? -1.0 : 1.0;
    pose.rollFree = solver.eigenvalues()(2) <= 2.0 * solver.eigenvalues()(1);
    const dvec3 sceneX = fixture.orientation * dvec3(1, 0, 0),
                longAxis = fromEigen(solver.eigenvectors().col(2));
    pose.target.rotation = facing(
        pose.normal, pose.rollFree ? sceneX : longAxis * (glm::dot(longAxis, sceneX) < 0.0 ? -1.0 : 1.0));
    pose.target.position = m.mean + fixture.standoff * pose.normal;
    return pose;
}

std::vector<uint8_t> largestPart(int width, int height, std::span<const uint32_t> masks,
                                 const PointImage& points, size_t c, double edge) {
    const auto in = [&](size_t i) { return (masks[i] >> c & 1) != 0 && points.z[i] != 0.0; };
    Parts parts(masks.size());
    for (int v = 0; v < height; ++v) {
        for (int u = 0; u < width; ++u) {
            const auto i = static_cast<size_t>(v * width + u);
            for (const auto& [du, dv] : {std::pair{-1, 0}, {-1, -1}, {0, -1}, {1, -1}}) {
                if (u + du < 0 || u + du >= width || v + dv < 0) {
                    continue;
                }
                const auto j = static_cast<size_t>((v + dv) * width + u + du);
                const bool near = edge == 0.0 || std::abs(points.z[i] - points.z[j]) <=
                                                     edge * std::min(points.z[i], points.z[j]);
                if (in(i) && in(j) && near) {
                    parts.join(i, j);
                }
            }
        }
    }
    std::vector<uint32_t> sizes(masks.size(), 0);
    for (size_t i = 0; i < masks.size(); ++i) {
        sizes[parts.root(i)] += in(i) ? 1 : 0;
    }
    const size_t best = static_cast<size_t>(std::max_element(sizes.begin(), sizes.end()) - sizes.begin());
    std::vector<uint8_t> marks(masks.size(), 0);
    for (size_t i = 0; i < masks.size(); ++i) {
        marks[i] = in(i) && parts.root(i) == best ? 1 : 0;
    }
    return marks;
}

std::vector<dvec3> trimmed(std::vector<dvec3> points, double share) {
    const dvec3 mean = moments(points).mean;
    std::stable_sort(points.begin(), points.end(), [&](const dvec3& a, const dvec3& b) {
        return glm::distance(a, mean) < glm::distance(b, mean);
    });
    points.resize(points.size() - static_cast<size_t>(share * static_cast<double>(points.size())));
    return points;
}

} // namespace fathom::reference
