// SPDX-License-Identifier: Apache-2.0
#include "engine/haptics/reaction.h"

#include "engine/haptics/limits.h"

#include <algorithm>
#include <cmath>

namespace fathom {

namespace {

constexpr double kSlowest = 10.0;       // [N/s] of a rise after new data
constexpr double kRoundingForce = 1e-6; // [N] rounding

// sqrt(|f|^2 + |tau / k|^2) [N]: the norm in which the spring wrench is K_t times the metric distance.
double sizeOf(const Wrench& wrench, double k) noexcept {
    const dvec3 turn = wrench.torque / k;
    return std::sqrt(glm::dot(wrench.force, wrench.force) + glm::dot(turn, turn));
}

} // namespace

double Reaction::rate(double wanted, const ReactionInput& input) noexcept {
    since_ += input.period;
    if (input.newData) {
        interval_ = std::clamp(since_, input.period, kLongestFrame);
        since_ = 0.0;
        rate_ = std::clamp((wanted - size_) / interval_, kSlowest, kAppear);
    }
    return since_ < interval_ ? rate_ : kAppear;
}

void Reaction::vanish() noexcept {
    faded_ = last_;
    fadedSize_ = size_;
    left_ = kTail;
}

// The fading rest of a reaction whose regions vanished; a new reaction takes its place.
Wrench Reaction::tail(double size, double period) noexcept {
    left_ = std::max(0.0, left_ - period);
    const double share = fadedSize_ > 0.0 ? std::max(0.0, left_ / kTail - size / fadedSize_) : 0.0;
    return scaled(faded_, share);
}

// How far the hand moved against a reaction [m]: the distance to the surface of a convex body grows
// by at most that along the old direction, and the distance to a convex free space along the new one.
double Reaction::inwards(const Wrench& reaction, double k, const Pose& end) const noexcept {
    const double size = sizeOf(reaction, k);
    if (!started_ || !(size > 0.0)) {
        return 0.0;
    }
    const dvec3 turned = rotationLog(end.rotation * glm::conjugate(end_.rotation));
    return -(glm::dot(end.position - end_.position, reaction.force) + glm::dot(turned, reaction.torque)) /
           size;
}

Wrench Reaction::step(const ReactionInput& input) noexcept {
    const double k = std::max(1e-6, input.springs.metricRadius);
    Wrench wrench = couple(input.springs, input.allowed, input.end, dvec3(0.0), dvec3(0.0));
    const double wanted = sizeOf(wrench, k);
    const double before = inwards(before_, k, input.end), now = inwards(wrench, k, input.end);
    const double compressed = input.springs.stiffness * std::max({before, now, 0.0});
    const double calm = std::clamp(1.0 + now / (kLeaves * input.period), 0.0, 1.0);
    const double grows = compressed + calm * rate(wanted, input) * input.period;
    before_ = wrench;
    const double most = size_ + (input.mayRise ? grows : 0.0);
    appears_ = wanted > size_ + compressed * (1.0 + 1e-9) + kRoundingForce;
    if (wanted > most) {
        wrench = scaled(wrench, most / wanted);
    }
    size_ = std::min(wanted, most);
    end_ = input.end;
    started_ = true;
    if (left_ > 0.0) {
        const Wrench rest = tail(size_, input.period);
        wrench = {wrench.force + rest.force, wrench.torque + rest.torque};
    }
    last_ = wrench;
    return wrench;
}

} // namespace fathom
