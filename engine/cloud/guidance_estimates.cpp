// SPDX-License-Identifier: Apache-2.0
#include "engine/cloud/guidance_estimates.h"

#include <algorithm>
#include <glm/geometric.hpp>

namespace fathom::cloud {

namespace {

constexpr double kLongestPause = 0.25; // [s]
constexpr double kMaxFrames = 300.0;   // in a mean: a swaying camera repeats in about 10 s
constexpr double kRecentGain = 0.25;   // the recent mean spans about 4 frames
constexpr double kGate = 0.002;        // [m] mean to recent mean; a view from another side changes less
constexpr double kPlay = 0.0005;       // [m]
constexpr double kTurnGate = 0.05;     // [rad]
constexpr double kTurnPlay = 0.005;    // [rad]
constexpr double kLargestTurn = 1.0;   // [rad] from where a rotation's mean began
constexpr uint32_t kSwitchFrames = 15; // [frames] with another plane or roll

dvec3 beyond(const dvec3& v, double limit) noexcept {
    const double length = glm::length(v);
    return length > limit ? v * (1.0 - limit / length) : dvec3(0.0);
}

} // namespace

const dvec3& SteadyVector::step(const dvec3& measured) noexcept {
    if (count_ == 0.0) {
        count_ = 1.0;
        return shown_ = mean_ = measured;
    }
    recent_ += kRecentGain * (measured - mean_ - recent_);
    count_ = std::min(count_ + 1.0, kMaxFrames);
    const dvec3 moved = (measured - mean_) / count_;
    const dvec3 lag = beyond(recent_ - moved, gate_);
    if (lag != dvec3(0.0)) { // it moves: earlier frames count less
        count_ = std::max(2.0, 0.5 * count_);
    }
    mean_ += moved + lag;
    recent_ -= moved + lag;
    shown_ += beyond(mean_ - shown_, play_);
    return shown_;
}

GuidanceEstimates::Settled::Settled(const GuidancePose& first)
    : position(kGate, kPlay)
    , rotation(kTurnGate, kTurnPlay)
    , reference(first.target.rotation)
    , turned(first.target.rotation)
    , planar(first.planar)
    , rollFree(first.rollFree) {}

void GuidanceEstimates::Settled::turn(const GuidancePose& pose) {
    const bool same = pose.planar == planar && pose.rollFree == rollFree;
    others = same ? 0 : others + 1;
    if (!same && others < kSwitchFrames) {
        return;
    }
    const dvec3 measured = rotationBetween(reference, pose.target.rotation);
    if (!same || glm::length(measured) > kLargestTurn) {
        planar = pose.planar;
        rollFree = pose.rollFree;
        others = 0;
        reference = pose.target.rotation;
        rotation = SteadyVector(kTurnGate, kTurnPlay);
        rotation.step(dvec3(0.0));
        turned = reference;
        return;
    }
    turned = glm::normalize(rotationExp(rotation.step(measured)) * reference);
}

void GuidanceEstimates::settle(Settled& settled, GuidancePose& pose, double standoff, const dvec3& camera) {
    const dvec3 position = settled.position.step(pose.position);
    settled.turn(pose);
    const dvec3 away = camera - position;
    dvec3 axis = glm::length(away) > 0.0 ? glm::normalize(away) : dvec3(0, 0, -1);
    if (settled.planar) {
        axis = -(settled.turned * dvec3(0, 0, 1));
    }
    if (pose.planar != settled.planar) {
        pose.normal = settled.planar ? axis : dvec3(0.0);
    }
    pose.planar = settled.planar;
    pose.rollFree = settled.rollFree;
    pose.standoff = standoff * axis;
    pose.target = {position + pose.standoff, settled.turned};
}

void GuidanceEstimates::apply(std::span<GuidancePose> poses, const Scene& scene, const dvec3& camera,
                              double captureTime) {
    const double since = captureTime - last_;
    if (!(since > 0.0 && since <= kLongestPause)) {
        classes_.clear();
    }
    last_ = captureTime;
    for (GuidancePose& pose : poses) {
        if (!pose.present || !isFinite(pose.target)) {
            continue;
        }
        const auto [known, isNew] = classes_.try_emplace(pose.fixture, pose);
        if (isNew) {
            known->second.position.step(pose.position);
            known->second.rotation.step(dvec3(0.0));
        } else {
            settle(known->second, pose, scene.fixtures[pose.fixture].standoff, camera);
        }
    }
}

} // namespace fathom::cloud
