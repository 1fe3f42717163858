// SPDX-License-Identifier: Apache-2.0
#include "engine/haptics/singular_release.h"

#include "engine/haptics/jacobi.h"

#include <algorithm>
#include <cmath>

namespace fathom {

namespace {

constexpr double kNudge = 1e-3;     // [rad], [m] length of a step
constexpr double kMinPull = 1e-5;   // [m] errors below are left alone
constexpr double kStuck = 0.01;     // of the error's square: a solve that removes less is stuck
constexpr double kMinRadius = 0.01; // [m] radius of curvature of the tip's path that is worth a step
// The same for a turn. At an offset wrist one joint turns another's axis towards the error, and that joint
// then removes it: the squared error falls with the square of the error itself.
constexpr double kMinTurn = 0.05; // [1 / rad^2]

} // namespace

SingularRelease::SingularRelease(const ArmModel& arm, const ReleaseWeights& weights) noexcept
    : arm_(arm)
    , weights_(weights)
    , joints_(arm) {}

void SingularRelease::reset(const JointVector& q) noexcept {
    known_ = released_ = false;
    pause_ = tries_ = 0;
    regular_ = at_ = q;
}

bool SingularRelease::begin(bool singular, const JointVector& q) noexcept {
    pause_ = std::max(0, pause_ - 1);
    if (singular) {
        return false;
    }
    double before = 0.0, after = 0.0;
    for (size_t k = 0; k < arm_.count(); ++k) {
        if (!arm_.joints[k].mimic) {
            before += way_[joints_.column[k]] * (regular_[k] - at_[k]);
            after += way_[joints_.column[k]] * (q[k] - at_[k]);
        }
    }
    const bool flipped = released_ && known_ && before * after < 0.0;
    regular_ = q;
    known_ = true;
    released_ = false;
    tries_ = 0;
    return flipped;
}

// Second derivative of the tip's pose by joints i <= j, along the error.
double SingularRelease::curvature(const Pull& pull, size_t i, size_t j) const noexcept {
    if (arm_.joints[i].slides) {
        return 0.0;
    }
    const dvec3 first = arm_.axisOf(pull.frames, i), second = arm_.axisOf(pull.frames, j);
    const dvec3 bend = glm::cross(first, arm_.motionOf(pull.frames, j, arm_.tip(pull.frames).position));
    const double turn = arm_.joints[j].slides ? 0.0 : glm::dot(pull.whole.alpha, glm::cross(first, second));
    return glm::dot(pull.whole.a, bend) + 0.5 * pull.metricRadius * pull.metricRadius * turn;
}

bool SingularRelease::fits(const JointVector& step, const JointVector& q) const noexcept {
    for (size_t k = 0; k < arm_.count(); ++k) {
        const double to = q[k] + joints_.gain[k] * step[joints_.column[k]];
        if (!arm_.joints[k].mimic && (to < arm_.joints[k].lower || to > arm_.joints[k].upper)) {
            return false;
        }
    }
    return true;
}

// Of the two directions along the same line.
double SingularRelease::signOf(const JointVector& direction, const JointVector& q) noexcept {
    double score = 0.0, last = 0.0;
    for (size_t k = 0; k < arm_.count(); ++k) {
        const ArmJoint& joint = arm_.joints[k];
        if (joint.mimic) {
            continue;
        }
        const double along = direction[joints_.column[k]], range = joint.upper - joint.lower;
        score += known_ ? weights_.continuity * along * (regular_[k] - q[k]) : 0.0;
        if (std::isfinite(range) && range > 0.0) {
            score += weights_.centring * along * (0.5 * (joint.lower + joint.upper) - q[k]) / range;
        }
        last = std::abs(along) > 0.1 ? along : last; // nothing decides: the joint nearest to the tip turns up
    }
    const double sign = (std::abs(score) > 1e-9 ? score : last) < 0.0 ? -1.0 : 1.0;
    return tries_ / kPatience % 2 == 1 ? -sign : sign; // blocked on one side: the other one
}

SingularRelease::Descent SingularRelease::descent(const ArmNormal& normal, const Pull& pull) const noexcept {
    SquareMatrix<kMaxJoints> hessian = normal.gram(), vectors{};
    for (size_t j = 0; j < arm_.count(); ++j) {
        for (size_t i = 0; i <= j; ++i) {
            const double bend = joints_.gain[i] * joints_.gain[j] * curvature(pull, i, j);
            hessian[joints_.column[i]][joints_.column[j]] -= bend;
            if (i != j) {
                hessian[joints_.column[j]][joints_.column[i]] -= bend;
            }
        }
    }
    for (size_t u = 0; u < joints_.unknowns; ++u) {
        vectors[u][u] = 1.0;
    }
    diagonalise(hessian, joints_.unknowns, &vectors);
    size_t least = 0;
    for (size_t u = 1; u < joints_.unknowns; ++u) {
        least = hessian[u][u] < hessian[least][least] ? u : least;
    }
    Descent found;
    for (size_t u = 0; u < joints_.unknowns; ++u) {
        found.way[u] = vectors[u][least];
    }
    found.fall = -hessian[least][least];
    return found;
}

// Adds a step along the line to `wanted`, towards the better side that the joint limits allow.
bool SingularRelease::take(const JointVector& way, const Pull& pull, JointVector& wanted) noexcept {
    const double length = kNudge * signOf(way, pull.q);
    for (const double sign : {1.0, -1.0}) {
        JointVector tried{};
        for (size_t u = 0; u < joints_.unknowns; ++u) {
            tried[u] = sign * length * way[u];
        }
        if (fits(tried, pull.q)) {
            for (size_t u = 0; u < joints_.unknowns; ++u) {
                wanted[u] += tried[u];
            }
            released_ = true;
            at_ = pull.q;
            way_ = way;
            ++tries_;
            return true;
        }
    }
    return false;
}

bool SingularRelease::nudge(const ArmNormal& normal, const Pull& pull, JointVector& wanted) noexcept {
    const double left = lengthOf(pull.left, pull.metricRadius);
    JointVector gradient{};
    normal.gradient(pull.left.a, pull.metricRadius * pull.left.alpha, gradient);
    double gain = 0.0;
    for (size_t u = 0; u < joints_.unknowns; ++u) {
        gain += gradient[u] * wanted[u];
    }
    if (pause_ > 0 || left < kMinPull || gain > kStuck * left * left) {
        return false;
    }
    // The shortened error would hide the fall at a saddle whose joints first move only each other.
    const double whole = lengthOf(pull.whole, pull.metricRadius);
    const Descent found = descent(normal, pull);
    double slope = 0.0;
    for (size_t u = 0; u < joints_.unknowns; ++u) {
        slope += found.way[u] * gradient[u] * whole / left;
    }
    if (found.fall < std::min(kMinRadius, kMinTurn * whole) * whole ||
        std::abs(slope) > found.fall * kNudge) {
        return false; // a minimum, or already on the way down
    }
    return take(found.way, pull, wanted);
}

} // namespace fathom
