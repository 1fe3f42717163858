// SPDX-License-Identifier: Apache-2.0
#include "engine/haptics/guidance.h"

#include "engine/haptics/force_ramps.h"
#include "engine/types/angle.h"

#include <algorithm>
#include <cmath>

namespace fathom {

dvec3 axisTurn(const dquat& from, const dquat& to) noexcept {
    const dvec3 a = from * dvec3(0.0, 0.0, 1.0), b = to * dvec3(0.0, 0.0, 1.0);
    const dvec3 normal = glm::cross(a, b);
    const double sine = glm::length(normal), cosine = glm::dot(a, b);
    if (sine > 1e-12) {
        return normal * (std::atan2(sine, cosine) / sine);
    }
    // Opposite axes: all half rotations are equally short; use the one about the tool's x.
    return cosine < 0.0 ? from * dvec3(0.5 * kTurn, 0.0, 0.0) : normal;
}

void Guidance::step(std::span<const GuidancePose> poses, const Pose& device, bool button, bool cut, double dt,
                    const GuidanceReach& reach) noexcept {
    if (button && !button_) {
        waiting_ = true;
    }
    waiting_ = waiting_ && button && !cut;
    button_ = button;
    cut_ = cut_ || cut;
    if (waiting_ && !cut_) {
        choose(poses, device);
    }
    follow(poses, dt);
    const bool pulls = button && !waiting_ && chosen_ >= 0 && lost_ <= limits_.holdTime && !cut_;
    const double change = cut_ ? std::max(dt / ForceRamps::kRampTime, easeStep(dt)) : easeStep(dt);
    phase_ = std::clamp(phase_ + (pulls ? change : -change), 0.0, 1.0);
    weight_ = phase_ * phase_ * (3.0 - 2.0 * phase_);
    advance(device, reach, dt);
    if (phase_ == 0.0 && (cut_ || !button)) {
        chosen_ = -1;
        cut_ = false;
    }
}

void Guidance::choose(std::span<const GuidancePose> poses, const Pose& device) noexcept {
    int nearest = -1;
    double least = 0.0;
    for (size_t i = 0; i < poses.size(); ++i) {
        const double distance = glm::distance(poses[i].target.position, device.position);
        if (poses[i].present && isFinite(poses[i].target) && (nearest < 0 || distance < least)) {
            nearest = static_cast<int>(i);
            least = distance;
        }
    }
    if (nearest < 0) {
        return;
    }
    chosen_ = nearest;
    standoff_ = poses[static_cast<size_t>(nearest)].standoff;
    lost_ = 0.0;
    waiting_ = false;
}

void Guidance::follow(std::span<const GuidancePose> poses, double dt) noexcept {
    if (chosen_ < 0) {
        return;
    }
    const auto index = static_cast<size_t>(chosen_);
    if (index >= poses.size() || !poses[index].present || !isFinite(poses[index].target)) {
        lost_ += dt;
        return;
    }
    lost_ = 0.0;
    const GuidancePose& pose = poses[index];
    // Without a plane the scene's full orientation applies.
    const double roll = pose.rollFree && pose.planar ? 0.0 : 1.0;
    roll_ = phase_ == 0.0 ? roll : roll_ + std::clamp(roll - roll_, -easeStep(dt), easeStep(dt));
    Pose wanted = pose.target;
    if (!pose.planar) {
        wanted.position += standoff_ - pose.standoff;
    }
    if (phase_ == 0.0) { // no force yet: start at the target itself
        target_ = wanted;
        return;
    }
    target_.position += clampLength(wanted.position - target_.position, limits_.speed * dt);
    const dvec3 turn = rotationBetween(target_.rotation, wanted.rotation);
    target_.rotation =
        glm::normalize(rotationExp(clampLength(turn, limits_.turnSpeed * dt)) * target_.rotation);
}

// The point that pulls comes no nearer to the target than its speed allows, and the hand's own approach is
// taken off its lead. The speed eases in, so that no hand swings beyond it.
void Guidance::advance(const Pose& device, const GuidanceReach& reach, double dt) noexcept {
    const auto next = [&](double ahead, double before, double now, double speed, double most) {
        const double moved = std::isfinite(before - now) ? before - now : 0.0;
        return std::clamp(ahead + weight_ * speed * dt - moved, 0.0, weight_ * std::min(most, now));
    };
    if (chosen_ < 0 || weight_ == 0.0) {
        ahead_ = aheadAngle_ = 0.0;
    } else {
        ahead_ = next(ahead_, glm::distance(target_.position, device_.position),
                      glm::distance(target_.position, device.position), limits_.speed, reach.length);
        aheadAngle_ = next(aheadAngle_, glm::length(turnFrom(device_)), glm::length(turnFrom(device)),
                           limits_.turnSpeed, reach.angle);
    }
    device_ = device;
}

GuidanceReach Guidance::leadReach(const Springs& springs) const noexcept {
    return {limits_.force / springs.stiffness, limits_.torque / springs.rotationalStiffness};
}

GuidanceReach Guidance::pullReach(const Springs& springs) const noexcept {
    const double turnStiffness = springs.metricRadius * springs.metricRadius * springs.guidanceStiffness;
    return {limits_.force / springs.guidanceStiffness, limits_.torque / turnStiffness};
}

dvec3 Guidance::turnFrom(const Pose& device) const noexcept {
    const dvec3 axis = axisTurn(device.rotation, target_.rotation);
    const dvec3 whole = rotationBetween(device.rotation, target_.rotation);
    return roll_ == 1.0 ? whole : axis + roll_ * (whole - axis);
}

// The part of `way` to the target that is ahead of the hand. most: what the speed has allowed so far.
dvec3 Guidance::ahead(const dvec3& way, double reach, double most) const noexcept {
    return clampLength(weight_ * clampLength(way, reach), most);
}

Guidance::Lead Guidance::lead(const Pose& device, const Springs& springs) const noexcept {
    if (chosen_ < 0 || weight_ == 0.0) {
        return {};
    }
    const GuidanceReach reach = leadReach(springs);
    return {ahead(target_.position - device.position, reach.length, ahead_),
            ahead(turnFrom(device), reach.angle, aheadAngle_)};
}

Wrench Guidance::pull(const Pose& device, const Springs& springs) const noexcept {
    if (chosen_ < 0 || weight_ == 0.0) {
        return {};
    }
    const GuidanceReach reach = pullReach(springs);
    const double turnStiffness = springs.metricRadius * springs.metricRadius * springs.guidanceStiffness;
    return {springs.guidanceStiffness * ahead(target_.position - device.position, reach.length, ahead_),
            turnStiffness * ahead(turnFrom(device), reach.angle, aheadAngle_)};
}

} // namespace fathom
