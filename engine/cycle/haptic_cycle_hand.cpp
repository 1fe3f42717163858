// SPDX-License-Identifier: Apache-2.0
// The part of a step that moves the hand map: pressed regions that vanish, a tool that lags, the clutch.
#include "engine/cycle/haptic_cycle.h"

#include "engine/haptics/limits.h"

#include <algorithm>

namespace fathom {
namespace {

// A region counts as vanished if the spring loses more than a length along it, and at most kStillHeld [m]
// remains there. The length has kPartGone [N] with stiff springs; noise causes less than the smallest one.
constexpr double kPartGone = 5.0, kMinPartGone = SurfaceNoise::kBand, kMaxPartGone = 0.005,
                 kStillHeld = 0.0005;
constexpr double kSameWay = 0.8; // cosine between directions that count as the same one
// [N] A larger force fades out even if its surface only moved back. Without the fade the pilot would feel a
// jolt.
constexpr double kFollowedForce = 3.0;
constexpr dquat kNoTurn{1.0, 0.0, 0.0, 0.0};

// True if a spring that held `before` [m] now holds `held` although the hand moved by `byHand` [m] only: it
// lost its length, and no row holds there. Friction on other rows keeps the tool back by `stuck` [m], which
// is no hold.
bool lostItsHold(const dvec3& before, const dvec3& held, const dvec3& stuck, double byHand,
                 const Springs& springs) {
    const double partGone = std::clamp(kPartGone / springs.stiffness, kMinPartGone, kMaxPartGone);
    const dvec3 lost = before - held;
    const bool fell = glm::length(held) < glm::length(before) - byHand - partGone;
    return fell && glm::dot(held + stuck, lost) <= kStillHeld * glm::length(lost);
}

} // namespace

// The regions that pressed by a torque are gone. Turns count as lengths, by the metric radius.
bool HapticCycle::turnVanished(const ProxyStep& moved, const Pose& endBefore) const noexcept {
    const Springs& springs = watch_.springs();
    const auto turnOf = [&](const Pose& pose) { // from the hand's end of the spring [m]
        return springs.metricRadius * rotationBetween(springEnd_.rotation, pose.rotation);
    };
    const dvec3 held = moved.active.empty() ? dvec3(0.0) : turnOf(moved.allowed);
    const dvec3 stuck = springs.metricRadius * moved.stuckTurn;
    return !arm_ && lostItsHold(turnOf(allowed_), held, stuck, glm::length(turnOf(endBefore)), springs);
}

// A region stopped the tool, and the hand moved farther. The shift changes no force, because there is none.
void HapticCycle::recentre() noexcept {
    const dvec3 by = tool_.position - device_.position;
    map_.align(handle_, tool_);
    device_ = tool_;
    stage_.shift(by, kNoTurn);
}

// The hand moved or turned out of the regions that pressed. Arguments as in vanishedAlong().
bool HapticCycle::handLeft(const Pose& before, const Pose& endBefore) const noexcept {
    const double moved = glm::dot(before.position - springEnd_.position, pressing_.spring);
    const double turned = glm::dot(rotationBetween(springEnd_.rotation, before.rotation),
                                   rotationBetween(endBefore.rotation, allowed_.rotation));
    const double k = watch_.springs().metricRadius;
    return moved < 0.0 || moved + k * k * turned < 0.0;
}

// The direction along which regions that pressed are gone although the hand did not move out of them: their
// class is no longer seen, or their shape was removed. Zero = those that are gone pressed by a torque alone;
// empty = none are. `before` and `endBefore` are where the tool and the hand's end of the spring were when
// they pressed.
std::optional<dvec3> HapticCycle::vanishedAlong(const ProxyStep& moved, const ContactSet* set,
                                                const Pose& before, const Pose& endBefore) const noexcept {
    if (!pressing_.rows || moved.trapped || handLeft(before, endBefore)) {
        return std::nullopt;
    }
    const bool rows = !moved.active.empty();
    // A set that lists nothing shows nothing that is near, however short its reach is. An arm may not yet
    // have followed a surface that lies between it and the hand.
    const bool none = set == nullptr || !(moved.minGap < set->reach);
    const bool away = !rows && (none || moved.minGap > kVanishedGap + behindHand());
    if (away && !(stage_.reaction() <= kFollowedForce && wentBack(set, pressing_.spring))) {
        return pressing_.spring;
    }
    if (jointLimits_ != 0) {
        return std::nullopt;
    }
    // Other regions press or are near.
    const dvec3 held = rows ? moved.allowed.position - springEnd_.position : dvec3(0.0);
    const double byHand = glm::distance(springEnd_.position, endBefore.position);
    const dvec3 lost = pressing_.spring - held;
    if (!arm_ && lostItsHold(pressing_.spring, held, moved.stuck, byHand, watch_.springs()) &&
        !wentBack(set, lost)) {
        return lost;
    }
    return turnVanished(moved, endBefore) ? std::optional(dvec3(0.0)) : std::nullopt;
}

// [m] from a pressed arm's tip to the hand's end of the spring; 0 for a tool without an arm.
double HapticCycle::behindHand() const noexcept {
    return arm_ && pressing_.rows ? glm::distance(tool_.position, springEnd_.position) : 0.0;
}

// A surface that pressed along `out` went back by no more than the tool follows in a tick. Reads the set's
// pairs, so only where the rows have changed that much.
bool HapticCycle::wentBack(const ContactSet* set, const dvec3& out) const noexcept {
    const double followed = options_.proxy.solves * options_.proxy.stepCap, length = glm::length(out);
    for (uint32_t leaf = 0; set != nullptr && !arm_ && leaf < set->leafCount(); ++leaf) {
        for (uint32_t i = set->pairBegin[leaf]; i < set->pairsUpTo(leaf, followed); ++i) {
            const dvec3 apart = set->leafAtQuery[leaf] - dvec3(set->pairX[i], set->pairY[i], set->pairZ[i]);
            const double distance = glm::length(apart);
            const bool pressed =
                pressing_.fixtures[set->fixture[set->pairSphere[i]] % pressing_.fixtures.size()];
            const double gap = distance - leafRadius(leaf) - static_cast<double>(set->pairRadius[i]);
            if (pressed && gap <= followed && glm::dot(apart, out) > kSameWay * distance * length) {
                return true;
            }
        }
    }
    return false;
}

// Moves the hand map by `by` [m], and with it the pose that the hand commands. `turn` turns that pose.
void HapticCycle::shiftHand(const dvec3& by, const dquat& turn) noexcept {
    device_ = {device_.position + by, glm::normalize(turn * device_.rotation)};
    springEnd_ = {springEnd_.position + by, glm::normalize(turn * springEnd_.rotation)};
    map_.shift(by);
    if (turn != kNoTurn) {
        map_.align(handle_, device_);
    }
    stage_.shift(by, turn);
    guidance_.shift(by, turn);
    handShift_.total += by;
    if (proxy_) {
        proxy_->setTarget(springEnd_);
    }
}

// Pressed regions vanished: the tool stays where it was before, and the hand with it. Otherwise the tool
// would jump at the hand, through what can no longer be seen.
void HapticCycle::keepHandAtTool(const Pose& before, const Pose& endBefore, const dvec3& along,
                                 ProxyStep& moved) noexcept {
    const bool all = moved.active.empty();
    const bool turned = all || turnVanished(moved, endBefore);
    if (proxy_ && !moved.escape) { // else it had to leave
        tool_ = moved.pose = before;
        proxy_->setPose(before);
    }
    const dvec3 apart = tool_.position - springEnd_.position;
    const dvec3 by = all ? apart : projectedOn(apart, along);
    const dvec3 free = by + projectedOn(moved.stuck, along); // friction ends with what it held back
    shiftHand(by, turned ? tool_.rotation * glm::conjugate(springEnd_.rotation) : kNoTurn);
    if (all) {
        moved.allowed = springEnd_;
    } else if (turned) { // the solver allowed a position for a tool that turns
        moved.allowed = {(glm::dot(along, along) > 0.0 ? moved.allowed : allowed_).position + free,
                         tool_.rotation};
    } else {
        moved.allowed.position += free;
    }
    moved.cut = !all;
    ++handShift_.vanished;
    handShift_.lagTime = 0.0;
}

void HapticCycle::takeUpLag(ProxyStep& moved, StepRecord& out) noexcept {
    const dvec3 lag = moved.cut ? moved.allowed.position - tool_.position : dvec3(0.0);
    out.lag = glm::length(lag);
    handShift_.lagTime = out.lag > kLagLength ? handShift_.lagTime + options_.period : 0.0;
    if (handShift_.lagTime > kLagTime && !arm_) {
        const dvec3 by = -(options_.period / kTakeUpTime) * lag;
        shiftHand(by, kNoTurn);
        moved.allowed.position += by;
    }
    out.indexShift = handShift_.total;
    out.vanished = handShift_.vanished;
}

} // namespace fathom
