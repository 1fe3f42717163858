// SPDX-License-Identifier: Apache-2.0
#include "engine/cycle/haptic_cycle.h"

#include <algorithm>
#include <cmath>

namespace fathom {
namespace {

constexpr double kCleanTime = 1.0; // [s] without a loss of the device before forces return
// A region counts as pressed if the reaction exceeds this force [N] or, with soft springs, the spring exceeds
// this length [m].
constexpr double kPressedForce = 0.5, kPressedLength = 0.0005;

// The pose that the hand commands before the first step.
Pose begin(HandMap& map, const Pose& start, const Pose* tool0, const ArmSetup* arm) {
    if (tool0 == nullptr) {
        return map.map(start, false);
    }
    const Pose tool = arm != nullptr ? arm->tipAt({arm->start, 0.0}) : *tool0;
    map.align(start, tool);
    return tool;
}

} // namespace

HapticCycle::HapticCycle(const Tool& tool, std::span<const Shape> shapes, const HapticOptions& options,
                         const Pose& start, const Pose* tool0, const ArmSetup* arm)
    : options_(options)
    , map_(options.baseRdevice, options.handScale)
    , guidance_(options.guidance)
    , armSetup_(arm)
    , watch_(options.device, options.coupling, options.springs)
    , stage_(options_)
    , ahead_(options.period)
    , springEnd_(begin(map_, start, tool0, arm))
    , device_(springEnd_)
    , handle_{start.position, glm::normalize(start.rotation)} {
    if (arm != nullptr) {
        arm_.emplace(arm->model, arm->baseTarm, arm->proxy, arm->start, shapes);
        tool_ = arm_->tip();
    } else {
        proxy_.emplace(tool, shapes, options.proxy, device_);
        tool_ = proxy_->pose();
        for (const Sphere& leaf : tool.leaves()) {
            leafRadius_.push_back(leaf.radius);
        }
    }
    springEnd_ = device_ = arm != nullptr ? device_ : tool_;
    allowed_ = springEnd_;
    stage_.restart(tool_);
}

StepRecord HapticCycle::step(const StepInput& input) noexcept {
    StepRecord out;
    out.t = time_ = input.time;
    const ContactSet* set = chooseSet(input, out);
    const Situation situation = situationOf(input, set, out);
    takeSample(input, situation);
    guidance_.step(input.guidance, device_, (input.buttons & kGuidanceButton) != 0,
                   situation.off || !situation.setReady || situation.armStill, options_.period,
                   options_.paperGuidance ? guidance_.pullReach(watch_.springs())
                                          : guidance_.leadReach(watch_.springs()));

    const bool newData = situation.movesTool && regionsChanged(set);
    const Pose before = tool_, endBefore = springEnd_;
    ProxyStep moved = stepTool(input, set, situation, newData, out);
    const std::optional<dvec3> gone = newData ? vanishedAlong(moved, set, before, endBefore) : std::nullopt;
    if (gone) {
        keepHandAtTool(before, endBefore, *gone, moved);
    }
    takeUpLag(moved, out);
    allowed_ = moved.allowed;
    makeWrench(input, situation, moved, newData, gone.has_value(), out);

    report(situation, moved, set != nullptr, out);
    recordTouches(set, moved, out);
    if (situation.sampleFinite) { // else nothing was seen to press
        notePressing(moved, out);
    }
    holdArm(situation, moved.trapped, out);
    fillMargins(input, out);
    watch_.step(input.measuredPeriod); // active from the next step on
    ahead_.moved(place(), input.measuredPeriod);
    return out;
}

HapticCycle::Situation HapticCycle::situationOf(const StepInput& input, const ContactSet* set,
                                                StepRecord& out) noexcept {
    Situation s;
    const Pose& hand = input.deviceThandle;
    s.sampleFinite = (input.unconfirmed ? isFinite(hand) : isUsable(hand)) && std::isfinite(input.time);
    s.off = lossesHoldForces(input) || input.forcesOff || (input.buttons & kDeadManOpen) != 0;
    s.setReady = set != nullptr || !options_.needsContacts;
    out.frame = set != nullptr ? set->frame : s.setReady ? input.frame : -1;
    out.sceneAge = out.frame >= 0 ? sceneAge(input, set) : kNotKnown;
    s.stale = isOld(out.sceneAge);
    s.armStill =
        realArm_.connected && (!realArm_.follows || !s.sampleFinite || s.off || !s.setReady || s.stale);
    const bool button = (input.buttons & options_.clutchBit) != 0;
    s.clutch = button || s.armStill || !input.present;
    s.recentre = button && !s.armStill && input.present && s.setReady && s.off && stage_.off();
    s.movesTool = s.setReady && s.sampleFinite && !s.armStill;
    return s;
}

// Counts a device that comes and goes. True while forces must stay off because of it.
bool HapticCycle::lossesHoldForces(const StepInput& input) noexcept {
    if (losses_.present && !input.present) {
        std::rotate(losses_.at.begin(), losses_.at.begin() + 1, losses_.at.end());
        losses_.at.back() = input.time;
    }
    losses_.present = input.present;
    const double since = input.time - losses_.at.back();
    losses_.many = since < kCleanTime && (losses_.many || input.time - losses_.at.front() < kCleanTime);
    return losses_.many || !input.present;
}

void HapticCycle::takeSample(const StepInput& input, const Situation& situation) noexcept {
    if (!situation.sampleFinite || (input.unconfirmed && input.present)) {
        return;
    }
    handle_ = {input.deviceThandle.position, glm::normalize(input.deviceThandle.rotation)};
    if (input.reindex) {
        map_.align(handle_, device_);
    }
    device_ = map_.map(handle_, situation.clutch);
    if (situation.recentre) {
        recentre();
    }
}

ProxyStep HapticCycle::stepTool(const StepInput& input, const ContactSet* set, const Situation& situation,
                                bool newData, StepRecord& out) noexcept {
    ProxyStep moved;
    moved.minGap = kNotKnown;
    springEnd_ = guidedEnd();
    jointLimits_ = 0;
    out.arm.posture = place().arm;
    if (situation.movesTool) {
        moved = moveTool(input, set, newData, out);
    } else {
        moved.allowed = allowed_; // held: the last reaction fades out
    }
    realArm_.wasStill = situation.armStill;
    freeDirection(moved);
    return moved;
}

bool HapticCycle::regionsChanged(const ContactSet* set) noexcept {
    const uint64_t generation = set != nullptr ? set->generation : regions_.generation;
    const bool changed = generation != regions_.generation || regions_.edited;
    regions_.generation = generation;
    regions_.edited = false;
    return changed;
}

void HapticCycle::report(const Situation& situation, const ProxyStep& moved, bool hasSet,
                         StepRecord& out) const noexcept {
    out.device = device_;
    out.tool = tool_;
    out.contactCount = static_cast<uint32_t>(moved.active.size()) + (moved.blocked ? 1 : 0);
    out.minGap = hasSet ? moved.minGap : kNotKnown;
    out.state = stateOf(situation, moved, out.lag > kLagLength);
    out.guidance = guidance_.weight();
    out.guidanceClass = guidance_.chosen();
    out.guidanceTarget = guidance_.target();
    out.stalled = moved.stalled;
    out.solves = moved.solves;
    out.infeasible = moved.infeasible;
}

// The part of the spring wrench that guidance adds. It moves the hand on purpose, so the passivity controller
// excludes it.
Wrench HapticCycle::guidancePull() const noexcept {
    return options_.paperGuidance ? guidance_.pull(device_, watch_.springs())
                                  : couple(watch_.springs(), springEnd_, device_);
}

void HapticCycle::makeWrench(const StepInput& input, const Situation& situation, const ProxyStep& moved,
                             bool newData, bool vanished, StepRecord& out) noexcept {
    WrenchInput tick;
    tick.allowed = moved.allowed;
    tick.springEnd = springEnd_;
    tick.device = device_;
    tick.baseRhandle = map_.baseRhandle(handle_);
    tick.springs = watch_.springs();
    tick.pull = guidancePull();
    tick.pushes =
        (moved.active.empty() && !moved.blocked ? 0 : cause::kRow) | (jointLimits_ == 0 ? 0 : cause::kJoint);
    const auto holds = [](const ActiveContact& c) { return c.row.kind == ContactRow::Kind::Equality; };
    tick.bothWays = !moved.active.empty() && std::ranges::all_of(moved.active, holds);
    tick.mayRise = !moved.rowsExpired && !input.unconfirmed;
    tick.newData = newData;
    tick.lags = arm_ && out.lag > kLagLength; // a free tool follows within some ticks
    tick.escape = moved.escape;
    tick.vanished = vanished;
    tick.forcesOn = situation.setReady && !situation.off && !situation.clutch;
    tick.off = situation.off;
    tick.trapped = moved.trapped;
    tick.stale = situation.stale;
    tick.sampleFinite = situation.sampleFinite;
    tick.rendered = input.present;
    tick.elapsed = input.measuredPeriod > 0.0 ? input.measuredPeriod : options_.period;
    const WrenchStage::Output made = stage_.step(tick);
    out.wrench = made.wrench;
    out.deviceWrench = map_.toDevice(made.delivered);
    out.residual = made.residual;
    out.finite = made.finite;
    out.cause = made.cause;
}

void HapticCycle::notePressing(const ProxyStep& moved, const StepRecord& out) noexcept {
    if (moved.trapped) { // what pressed before still holds the tool, unless the hand leaves it meanwhile
        const dvec3 spring = tool_.position - springEnd_.position;
        pressing_.rows = pressing_.rows && glm::dot(spring, pressing_.spring) >= 0.0;
        pressing_.spring = spring;
        return;
    }
    const double least = std::min(kPressedForce, kPressedLength * watch_.springs().stiffness);
    pressing_.rows = !moved.active.empty() && stage_.reaction() > least;
    pressing_.spring = moved.allowed.position - springEnd_.position;
    pressing_.fixtures.reset();
    for (const Touch& touch : std::span(out.touches).first(out.touchCount)) {
        if (touch.kind == ContactRow::Kind::Sphere) {
            pressing_.fixtures.set(touch.fixture % pressing_.fixtures.size());
        }
    }
}

StepState HapticCycle::stateOf(const Situation& situation, const ProxyStep& moved, bool lags) const noexcept {
    if (!situation.setReady) {
        return StepState::Off;
    }
    if (situation.off || situation.armStill) {
        return stage_.off() ? StepState::Off : StepState::Fading;
    }
    if (moved.trapped) {
        return StepState::Trapped;
    }
    if (situation.stale) {
        return StepState::Fading;
    }
    if (moved.escape) {
        return StepState::Escape;
    }
    if (moved.contact) {
        return StepState::Contact;
    }
    if (stage_.fades() && !arm_) { // an arm's force also fades while it follows a surface
        return StepState::Fading;
    }
    const bool jointPushes = jointLimits_ != 0 && stage_.reaction() > 0.0;
    return lags && !jointPushes ? StepState::Waiting : StepState::Free;
}

// An arm stands still while anything is wrong, and then until tool and hand meet again or are re-indexed.
// When a real arm follows, the tool never left it.
void HapticCycle::holdArm(const Situation& situation, bool trapped, StepRecord& out) noexcept {
    const bool wrong = !situation.sampleFinite || !situation.setReady || situation.off || situation.stale ||
                       trapped || !out.finite || situation.armStill;
    const bool met = situation.clutch || realArm_.connected ||
                     glm::distance(out.tool.position, out.device.position) <= kResumeWithin;
    realArm_.commandsHold = wrong || (realArm_.commandsHold && !met);
    out.armHold = realArm_.commandsHold;
}

void HapticCycle::fillMargins(const StepInput& input, StepRecord& out) const noexcept {
    CouplingOptions live = options_.coupling;
    if (input.measuredPeriod > 0.0) {
        live.period = input.measuredPeriod;
    }
    const auto margins = stabilityMargins(options_.device, watch_.springs(), live);
    out.marginPassive = margins.passive.value_or(kNotKnown);
    out.marginUncoupled = margins.uncoupled.value_or(kNotKnown);
}

} // namespace fathom
