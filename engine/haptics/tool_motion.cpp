// SPDX-License-Identifier: Apache-2.0
#include "engine/haptics/tool_motion.h"

#include "engine/contact/clones.h"

#include <glm/mat3x3.hpp>

#include <algorithm>
#include <cmath>

namespace fathom {

namespace {

constexpr size_t kTurningLanes = 8;

FATHOM_CLONES
void placeKernel(const double* __restrict x, const double* __restrict y, const double* __restrict z,
                 size_t count, const glm::dmat3& rotation, const dvec3& centre, double* __restrict toX,
                 double* __restrict toY, double* __restrict toZ) noexcept {
    const glm::dmat3 m = rotation; // copies: writing the columns changes neither
    const dvec3 c = centre;
    for (size_t i = 0; i < count; ++i) {
        toX[i] = c.x + (m[0][0] * x[i] + m[1][0] * y[i] + m[2][0] * z[i]);
        toY[i] = c.y + (m[0][1] * x[i] + m[1][1] * y[i] + m[2][1] * z[i]);
        toZ[i] = c.z + (m[0][2] * x[i] + m[1][2] * y[i] + m[2][2] * z[i]);
    }
}

// Largest |a x p|^2 over the points.
FATHOM_CLONES
double turningKernel(const double* __restrict x, const double* __restrict y, const double* __restrict z,
                     size_t count, double ax, double ay, double az) noexcept {
    double most[kTurningLanes] = {}; // as many as the widest register has, so that no comparison is reordered
    const auto take = [&](size_t i, size_t lane) {
        const double wx = ay * z[i] - y[i] * az, wy = az * x[i] - z[i] * ax, wz = ax * y[i] - x[i] * ay;
        const double square = wx * wx + wy * wy + wz * wz;
        most[lane] = square > most[lane] ? square : most[lane];
    };
    size_t i = 0;
    for (; i + kTurningLanes <= count; i += kTurningLanes) {
        for (size_t l = 0; l < kTurningLanes; ++l) {
            take(i + l, l);
        }
    }
    for (; i < count; ++i) {
        take(i, 0);
    }
    return *std::max_element(most, most + kTurningLanes);
}

} // namespace

Pose moved(const Pose& pose, const Motion& motion) noexcept {
    return {pose.position + motion.a, glm::normalize(rotationExp(motion.alpha) * pose.rotation)};
}

Motion remaining(const Pose& pose, const Pose& target) noexcept {
    if (target.rotation == pose.rotation) { // exactly there: rounding must not keep it rotating
        return {target.position - pose.position, dvec3(0.0)};
    }
    return {target.position - pose.position, rotationBetween(pose.rotation, target.rotation)};
}

double productOf(const Motion& a, const Motion& b, double k) noexcept {
    return glm::dot(a.a, b.a) + k * k * glm::dot(a.alpha, b.alpha);
}

double lengthOf(const Motion& motion, double k) noexcept {
    return std::sqrt(std::max(0.0, productOf(motion, motion, k)));
}

double divisorOf(const Motion& motion, double k) noexcept {
    return std::max(1e-150, lengthOf(motion, k));
}

LeafPlaces::LeafPlaces(const Tool& tool)
    : centres_(tool.leafCount()) {
    for (size_t i = 0; i < tool.leafCount(); ++i) {
        centres_.set(i, tool.leaves()[i].centre);
        farthest_ = std::max(farthest_, glm::length(tool.leaves()[i].centre));
    }
}

void placePoints(const LeafCentres& points, size_t first, size_t count, const Pose& pose, const dvec3& origin,
                 LeafCentres& out) noexcept {
    placeKernel(points.x.data() + first, points.y.data() + first, points.z.data() + first, count,
                glm::mat3_cast(pose.rotation), pose.position - origin, out.x.data() + first,
                out.y.data() + first, out.z.data() + first);
}

void LeafPlaces::place(const Pose& pose, const dvec3& origin, LeafCentres& out) const noexcept {
    placePoints(centres_, 0, centres_.size(), pose, origin, out);
}

double LeafPlaces::travelBound(const Pose& pose, const Motion& motion) const noexcept {
    const dvec3 alpha =
        glm::conjugate(pose.rotation) * motion.alpha; // |alpha x r| is the same in the tool frame
    const double turning = alpha == dvec3(0.0)
                               ? 0.0
                               : turningKernel(centres_.x.data(), centres_.y.data(), centres_.z.data(),
                                               centres_.size(), alpha.x, alpha.y, alpha.z);
    return glm::length(motion.a) + std::sqrt(turning);
}

void TrustRegion::set(const ContactSet& contacts, const LeafCentres& leaves) noexcept {
    const double farthest = leafDisplacement(contacts.leafAtQuery, leaves);
    limit_ = contacts.reach - kMargin;
    room_ = limit_ - farthest - 1e-9;
    beyond_ = farthest > limit_;
    if (beyond_) {
        leafDisplacements(contacts.leafAtQuery, leaves, bound_);
        for (double& bound : bound_) {
            bound = bound > limit_ ? bound : limit_;
        }
    }
}

bool TrustRegion::contains(const ContactSet& contacts, const LeafCentres& next) const noexcept {
    if (leavesWithin(contacts.leafAtQuery, next, limit_)) {
        return true;
    }
    for (size_t i = 0; i < bound_.size(); ++i) {
        if (!(glm::distance(next[i], contacts.leafAtQuery[i]) <= boundOf(i))) {
            return false;
        }
    }
    return true;
}

double TrustRegion::share(const ContactSet& contacts, const LeafCentres& from,
                          const LeafCentres& next) const noexcept {
    double least = 1.0;
    for (size_t i = 0; i < bound_.size(); ++i) {
        const dvec3 start = from[i] - contacts.leafAtQuery[i];
        const dvec3 end = next[i] - contacts.leafAtQuery[i];
        if (glm::length(end) <= boundOf(i)) {
            continue;
        }
        // Where the straight path leaves the ball: |start + t way|^2 = bound^2, the positive root.
        const dvec3 way = end - start;
        const double a = glm::dot(way, way), b = glm::dot(start, way);
        const double c = std::min(0.0, glm::dot(start, start) - boundOf(i) * boundOf(i));
        const double root = std::sqrt(std::max(0.0, b * b - a * c));
        // The form without cancellation for either sign of b.
        const double t = b > 0.0 ? -c / (b + root) : (root - b) / a;
        least = std::min(least, std::clamp(t, 0.0, 1.0));
    }
    return least;
}

bool TrustRegion::allows(const ContactSet& contacts, const LeafCentres& leaves) noexcept {
    const double limit = contacts.reach - kMargin + 1e-12;
    return contacts.leafAtQuery.size() == leaves.size() && leavesWithin(contacts.leafAtQuery, leaves, limit);
}

} // namespace fathom
