// SPDX-License-Identifier: Apache-2.0
#include "apps/register/rigid_fit.h"

#include "engine/types/error.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace fathom {

namespace {

constexpr double kMinSpread = 1e-3; // [m] across the points' main direction

Eigen::Vector3d toEigen(const dvec3& v) {
    return {v.x, v.y, v.z};
}

// Horn's symmetric matrix: its largest eigenvector is the rotation's quaternion (w, x, y, z).
Eigen::Matrix4d hornMatrix(const Eigen::Matrix3d& s) {
    Eigen::Matrix4d n;
    n << s(0, 0) + s(1, 1) + s(2, 2), s(1, 2) - s(2, 1), s(2, 0) - s(0, 2), s(0, 1) - s(1, 0), //
        s(1, 2) - s(2, 1), s(0, 0) - s(1, 1) - s(2, 2), s(0, 1) + s(1, 0), s(2, 0) + s(0, 2),  //
        s(2, 0) - s(0, 2), s(0, 1) + s(1, 0), -s(0, 0) + s(1, 1) - s(2, 2), s(1, 2) + s(2, 1), //
        s(0, 1) - s(1, 0), s(2, 0) + s(0, 2), s(1, 2) + s(2, 1), -s(0, 0) - s(1, 1) + s(2, 2);
    return n;
}

// Means and second moments of the pairs.
struct Moments {
    dvec3 camera{0.0}, base{0.0};
    Eigen::Matrix3d cross = Eigen::Matrix3d::Zero(), spread = Eigen::Matrix3d::Zero();

    explicit Moments(std::span<const PointPair> pairs) {
        const auto count = static_cast<double>(pairs.size());
        for (const PointPair& pair : pairs) {
            camera += pair.camera / count;
            base += pair.base / count;
        }
        for (const PointPair& pair : pairs) {
            const Eigen::Vector3d c = toEigen(pair.camera - camera), b = toEigen(pair.base - base);
            cross += c * b.transpose();
            spread += b * b.transpose() / count;
        }
    }
};

Pose poseOf(const Moments& m) {
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix4d> solver(hornMatrix(m.cross));
    const Eigen::Vector4d q = solver.eigenvectors().col(3);
    Pose pose;
    pose.rotation = glm::normalize(dquat(q(0), q(1), q(2), q(3)));
    pose.position = m.base - pose.rotation * m.camera;
    return pose;
}

// Information about the rotation, about the axis that the pairs fix least [m^2]: of the moments between both
// frames, because noise of one frame alone makes a line look like a surface.
double leastInformation(const Moments& m, const dquat& q) {
    const Eigen::Matrix3d turned =
        m.cross.transpose() * Eigen::Quaterniond(q.w, q.x, q.y, q.z).toRotationMatrix().transpose();
    const Eigen::Matrix3d even = 0.5 * (turned + turned.transpose());
    const Eigen::Matrix3d information = even.trace() * Eigen::Matrix3d::Identity() - even;
    return Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(information).eigenvalues()(0);
}

// A pair that is listed twice tells nothing new.
size_t differentPoints(std::span<const PointPair> pairs) {
    std::vector<std::array<double, 3>> points;
    for (const PointPair& pair : pairs) {
        points.push_back({pair.camera.x, pair.camera.y, pair.camera.z});
    }
    std::sort(points.begin(), points.end());
    return static_cast<size_t>(std::unique(points.begin(), points.end()) - points.begin());
}

} // namespace

Pose poseOf(std::span<const PointPair> pairs) {
    return poseOf(Moments(pairs));
}

RigidFit fitRigid(std::span<const PointPair> pairs, const std::string& source) {
    const auto count = static_cast<double>(pairs.size());
    if (const size_t points = differentPoints(pairs); points < 4) {
        throw BadInput(source, "pairs", std::to_string(points),
                       "4 or more, of different points, not on one line");
    }
    const Moments moments(pairs);
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> shape(moments.spread);
    if (!(shape.eigenvalues()(1) > kMinSpread * kMinSpread)) {
        throw BadInput(source, "pairs", "all on one line", "points that span a surface");
    }
    RigidFit fit;
    fit.baseTcamera = poseOf(moments);
    double squares = 0.0;
    for (const PointPair& pair : pairs) {
        const double distance =
            glm::length(fit.baseTcamera.rotation * pair.camera + fit.baseTcamera.position - pair.base);
        squares += distance * distance;
        if (distance >= fit.worst) {
            fit.worst = distance;
            fit.worstName = pair.name;
        }
    }
    // The pose uses six of the 3n degrees of freedom.
    fit.sigma = std::sqrt(squares / (count - 2.0));
    const double information = leastInformation(moments, fit.baseTcamera.rotation);
    fit.turn = information > 0.0 ? fit.sigma / std::sqrt(3.0 * information) : HUGE_VAL; // sigma is of 3 axes
    return fit;
}

} // namespace fathom
