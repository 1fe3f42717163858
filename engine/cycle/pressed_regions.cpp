// SPDX-License-Identifier: Apache-2.0
#include "engine/cycle/pressed_regions.h"

#include "engine/haptics/surface_noise.h"

#include <algorithm>

namespace fathom {
namespace {

// A region counts as pressed if the reaction exceeds this force [N] or, with soft springs, the spring exceeds
// this length [m].
constexpr double kPressedForce = 0.5, kPressedLength = 0.0005;
// A region counts as vanished if the spring loses more than a length along it, and at most kStillHeld [m]
// remains there. The length has kPartGone [N] with stiff springs; noise causes less than the smallest one.
constexpr double kPartGone = 5.0, kMinPartGone = SurfaceNoise::kBand, kMaxPartGone = 0.005,
                 kStillHeld = 0.0005;
// [m] If every region is farther away than this, those that pressed have vanished.
constexpr double kVanishedGap = 0.002;
constexpr double kSameWay = 0.8; // cosine between directions that count as the same one
// [N] A larger force fades out even if its surface only moved back. Without the fade the pilot would feel a
// jolt.
constexpr double kFollowedForce = 3.0;

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

// The regions that pressed by a torque are gone. Turns count as lengths, by the metric radius.
bool turnVanished(const SolvedStep& step, const StepPoses& before) {
    const Springs& springs = step.springs;
    const auto turnOf = [&](const Pose& pose) { // from the hand's end of the spring [m]
        return springs.metricRadius * rotationBetween(step.springEnd.rotation, pose.rotation);
    };
    const dvec3 held = step.moved.active.empty() ? dvec3(0.0) : turnOf(step.moved.allowed);
    const dvec3 stuck = springs.metricRadius * step.moved.stuckTurn;
    return !step.tool.onArm() &&
           lostItsHold(turnOf(before.allowed), held, stuck, glm::length(turnOf(before.springEnd)), springs);
}

} // namespace

std::optional<VanishedRegions> PressedRegions::vanished(const SolvedStep& step,
                                                        const StepPoses& before) const noexcept {
    const std::optional<dvec3> along = vanishedAlong(step, before);
    if (!along) {
        return std::nullopt;
    }
    const bool all = step.moved.active.empty();
    return VanishedRegions{*along, all, all || turnVanished(step, before)};
}

// The direction of VanishedRegions; empty = none vanished.
std::optional<dvec3> PressedRegions::vanishedAlong(const SolvedStep& step,
                                                   const StepPoses& before) const noexcept {
    const ProxyStep& moved = step.moved;
    if (!rows_ || moved.trapped || handLeft(step, before)) {
        return std::nullopt;
    }
    const bool rows = !moved.active.empty();
    // A set that lists nothing shows nothing that is near, however short its reach is. An arm may not yet
    // have followed a surface that lies between it and the hand.
    const bool none = step.set == nullptr || !(moved.minGap < step.set->reach);
    const bool away = !rows && (none || moved.minGap > kVanishedGap + behindHand(step.tool, step.springEnd));
    if (away && !(step.reaction <= kFollowedForce && wentBack(step, spring_))) {
        return spring_;
    }
    if (step.tool.jointLimits() != 0) {
        return std::nullopt;
    }
    // Other regions press or are near.
    const dvec3 held = rows ? moved.allowed.position - step.springEnd.position : dvec3(0.0);
    const double byHand = glm::distance(step.springEnd.position, before.springEnd.position);
    const dvec3 lost = spring_ - held;
    if (!step.tool.onArm() && lostItsHold(spring_, held, moved.stuck, byHand, step.springs) &&
        !wentBack(step, lost)) {
        return lost;
    }
    return turnVanished(step, before) ? std::optional(dvec3(0.0)) : std::nullopt;
}

// The hand moved or turned out of the regions that pressed.
bool PressedRegions::handLeft(const SolvedStep& step, const StepPoses& before) const noexcept {
    const double moved = glm::dot(before.tool.position - step.springEnd.position, spring_);
    const double turned = glm::dot(rotationBetween(step.springEnd.rotation, before.tool.rotation),
                                   rotationBetween(before.springEnd.rotation, before.allowed.rotation));
    const double k = step.springs.metricRadius;
    return moved < 0.0 || moved + k * k * turned < 0.0;
}

// A surface that pressed along `out` went back by no more than the tool follows in a tick. Reads the set's
// pairs, so only where the rows have changed that much.
bool PressedRegions::wentBack(const SolvedStep& step, const dvec3& out) const noexcept {
    const ContactSet* set = step.set;
    const bool freeTool = !step.tool.onArm();
    const double length = glm::length(out);
    for (uint32_t leaf = 0; set != nullptr && freeTool && leaf < set->leafCount(); ++leaf) {
        for (uint32_t i = set->pairBegin[leaf]; i < set->pairsUpTo(leaf, followed_); ++i) {
            const dvec3 apart = set->leafAtQuery[leaf] - dvec3(set->pairX[i], set->pairY[i], set->pairZ[i]);
            const double distance = glm::length(apart);
            const bool pressed = fixtures_[set->fixture[set->pairSphere[i]] % fixtures_.size()];
            const double gap =
                distance - step.tool.leafRadius(leaf) - static_cast<double>(set->pairRadius[i]);
            if (pressed && gap <= followed_ && glm::dot(apart, out) > kSameWay * distance * length) {
                return true;
            }
        }
    }
    return false;
}

double PressedRegions::behindHand(const ToolProxy& tool, const Pose& springEnd) const noexcept {
    return tool.onArm() && rows_ ? glm::distance(tool.pose().position, springEnd.position) : 0.0;
}

void PressedRegions::note(const SolvedStep& step, std::span<const Touch> touches) noexcept {
    const ProxyStep& moved = step.moved;
    if (moved.trapped) { // what pressed before still holds the tool, unless the hand leaves it meanwhile
        const dvec3 spring = step.tool.pose().position - step.springEnd.position;
        rows_ = rows_ && glm::dot(spring, spring_) >= 0.0;
        spring_ = spring;
        return;
    }
    const double least = std::min(kPressedForce, kPressedLength * step.springs.stiffness);
    rows_ = !moved.active.empty() && step.reaction > least;
    spring_ = moved.allowed.position - step.springEnd.position;
    fixtures_.reset();
    for (const Touch& touch : touches) {
        if (touch.kind == ContactRow::Kind::Sphere) {
            fixtures_.set(touch.fixture % fixtures_.size());
        }
    }
}

} // namespace fathom
