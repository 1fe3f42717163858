// SPDX-License-Identifier: Apache-2.0
#include "engine/haptics/guidance.h"

#include "engine/haptics/limits.h"

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
    return cosine < 0.0 ? from * dvec3(3.14159265358979323846, 0.0, 0.0) : normal;
}

void Guidance::step(std::span<const GuidancePose> poses, const Pose& device, bool button, bool cut,
                    double dt) noexcept {
    if (button && !button_) {
        waiting_ = true;
    }
    waiting_ = waiting_ && button;
    button_ = button;
    if (waiting_) {
        choose(poses, device);
    }
    follow(poses, dt);
    const bool pulls = button && !waiting_ && chosen_ >= 0 && lost_ <= limits_.holdTime && !cut;
    const double change = limits_.easeTime > 0.0 ? dt / limits_.easeTime : 1.0;
    phase_ = cut ? 0.0 : std::clamp(phase_ + (pulls ? change : -change), 0.0, 1.0);
    weight_ = phase_ * phase_ * (3.0 - 2.0 * phase_);
    if (cut || (phase_ == 0.0 && !button)) {
        chosen_ = -1;
        waiting_ = false;
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
    rollFree_ = pose.rollFree && pose.planar; // without a plane the scene's full orientation applies
    if (phase_ == 0.0) {                      // no force yet: start at the target itself
        target_ = pose.target;
        return;
    }
    target_.position += clampLength(pose.target.position - target_.position, limits_.slew * dt);
    const dvec3 turn = rotationLog(pose.target.rotation * glm::conjugate(target_.rotation));
    target_.rotation =
        glm::normalize(rotationExp(clampLength(turn, limits_.turnSlew * dt)) * target_.rotation);
}

dvec3 Guidance::turnFrom(const Pose& device) const noexcept {
    return rollFree_ ? axisTurn(device.rotation, target_.rotation)
                     : rotationLog(target_.rotation * glm::conjugate(device.rotation));
}

Guidance::Lead Guidance::lead(const Pose& device, const Springs& springs) const noexcept {
    if (chosen_ < 0 || weight_ == 0.0) {
        return {};
    }
    const double reach = limits_.force / springs.stiffness,
                 turn = limits_.torque / springs.rotationalStiffness;
    return {weight_ * clampLength(target_.position - device.position, reach),
            weight_ * clampLength(turnFrom(device), turn)};
}

Wrench Guidance::pull(const Pose& device, const Springs& springs) const noexcept {
    if (chosen_ < 0 || weight_ == 0.0) {
        return {};
    }
    const double turnStiffness = springs.metricRadius * springs.metricRadius * springs.guidanceStiffness;
    const dvec3 force = springs.guidanceStiffness * (target_.position - device.position);
    return {weight_ * clampLength(force, limits_.force),
            weight_ * clampLength(turnStiffness * turnFrom(device), limits_.torque)};
}

} // namespace fathom
