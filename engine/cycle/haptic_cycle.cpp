// SPDX-License-Identifier: Apache-2.0
#include "engine/cycle/haptic_cycle.h"

#include <algorithm>
#include <cmath>

namespace fathom {
namespace {

// The pose of the tool that the hand map is aligned to before the first step; empty = none.
std::optional<Pose> alignedTool(const Pose* tool0, const ArmSetup* arm) {
    if (tool0 == nullptr) {
        return std::nullopt;
    }
    return arm != nullptr ? arm->tipAt({arm->start, 0.0}) : *tool0;
}

StepState stateOf(const StepConditions& conditions, const ProxyStep& moved, const WrenchStage& stage,
                  const ToolProxy& tool, bool lags) {
    if (!conditions.setReady) {
        return StepState::Off;
    }
    if (conditions.off || conditions.armStill) {
        return stage.off() ? StepState::Off : StepState::Fading;
    }
    if (moved.trapped) {
        return StepState::Trapped;
    }
    if (conditions.stale) {
        return StepState::Fading;
    }
    if (moved.escape) {
        return StepState::Escape;
    }
    if (moved.contact) {
        return StepState::Contact;
    }
    if (stage.fades() && !tool.onArm()) { // an arm's force also fades while it follows a surface
        return StepState::Fading;
    }
    const bool jointPushes = tool.jointLimits() != 0 && stage.reaction() > 0.0;
    return lags && !jointPushes ? StepState::Waiting : StepState::Free;
}

void fillMargins(const HapticOptions& options, const Springs& springs, double measuredPeriod,
                 StepRecord& out) {
    CouplingOptions live = options.coupling;
    if (measuredPeriod > 0.0) {
        live.period = measuredPeriod;
    }
    const auto margins = stabilityMargins(options.device, springs, live);
    out.marginPassive = margins.passive.value_or(kNotKnown);
    out.marginUncoupled = margins.uncoupled.value_or(kNotKnown);
}

} // namespace

HapticCycle::HapticCycle(const Tool& tool, std::span<const Shape> shapes, const HapticOptions& options,
                         const Pose& start, const Pose* tool0, const ArmSetup* arm)
    : options_(options)
    , hand_(options_, start, alignedTool(tool0, arm))
    , tool_(tool, shapes, options.proxy, hand_.device(), arm)
    , pressed_(options.proxy)
    , watch_(options.device, options.coupling, options.springs)
    , stage_(options_)
    , ahead_(options.period) {
    if (!tool_.onArm()) {
        hand_.start(tool_.pose());
    }
    allowed_ = hand_.springEnd();
    stage_.restart(tool_.pose());
}

StepRecord HapticCycle::step(const StepInput& input) noexcept {
    StepRecord out;
    out.t = time_ = input.time;
    const ContactSet* set = chooseSet(input, out);
    const StepConditions conditions = conditionsOf(input, set, out);
    takeSample(input, conditions);

    const StepPoses before{tool_.pose(), allowed_, hand_.springEnd()};
    hand_.guide(input.guidance, (input.buttons & kGuidanceButton) != 0,
                conditions.off || !conditions.setReady || conditions.armStill, watch_.springs());
    ProxyStep moved = moveTool(input, set, conditions, out);
    const bool vanished = conditions.newData && keepHandAtTool(set, before, moved);
    if (const auto shift = hand_.takeUpLag(tool_, moved, out)) {
        shifted(*shift);
    }
    allowed_ = moved.allowed;
    WrenchInput tick = wrenchInput(input, conditions, moved);
    tick.lags = tool_.onArm() && out.lag > MappedHand::kLagLength; // a free tool follows within some ticks
    tick.vanished = vanished;
    makeWrench(tick, out);

    hand_.record(out);
    tool_.record(set, moved, out);
    out.state = stateOf(conditions, moved, stage_, tool_, out.lag > MappedHand::kLagLength);
    if (conditions.sampleFinite) { // else nothing was seen to press
        pressed_.note(solved(moved, set), std::span(out.touches).first(out.touchCount));
    }
    armHold_.step(conditions, moved.trapped, out);
    fillMargins(options_, watch_.springs(), input.measuredPeriod, out);
    watch_.step(input.measuredPeriod); // active from the next step on
    ahead_.moved(place(), input.measuredPeriod);
    return out;
}

bool HapticCycle::follow(const ArmFollow& status) noexcept {
    if (!tool_.onArm() || !armHold_.follow(status) || !stage_.off()) {
        return false;
    }
    tool_.setPosture(status.posture);
    placed_ = true;
    hand_.restart(tool_.pose());
    allowed_ = tool_.pose();
    stage_.restart(tool_.pose());
    ahead_.restart();
    return true;
}

const ContactSet* HapticCycle::chooseSet(const StepInput& input, StepRecord& out) noexcept {
    const ContactSet* offered = input.offered;
    if (offered != nullptr && offered->frame >= 0 && tool_.accepts(*offered)) {
        out.adopted = true;
        placed_ = false;
        ahead_.answered(offered->askedAt, input.time);
        return offered;
    }
    const bool usable = input.active != nullptr && input.active->frame >= 0;
    return usable && (!placed_ || tool_.accepts(*input.active)) ? input.active : nullptr;
}

StepConditions HapticCycle::conditionsOf(const StepInput& input, const ContactSet* set,
                                         StepRecord& out) noexcept {
    StepConditions s;
    const Pose& hand = input.deviceThandle;
    s.sampleFinite = (input.unconfirmed ? isFinite(hand) : isUsable(hand)) && std::isfinite(input.time);
    s.off = losses_.step(input.time, input.present) || input.forcesOff || (input.buttons & kDeadManOpen) != 0;
    s.setReady = set != nullptr || !options_.needsContacts;
    out.frame = set != nullptr ? set->frame : s.setReady ? input.frame : -1;
    out.sceneAge = out.frame >= 0 ? regions_.age(input, set) : kNotKnown;
    s.stale = isOld(out.sceneAge);
    s.armStill = armHold_.stands(s);
    const bool button = (input.buttons & options_.clutchBit) != 0;
    s.clutch = button || s.armStill || !input.present;
    s.recentre = button && !s.armStill && input.present && s.setReady && s.off && stage_.off();
    s.movesTool = s.setReady && s.sampleFinite && !s.armStill;
    s.newData = s.movesTool && regions_.changed(set);
    return s;
}

void HapticCycle::takeSample(const StepInput& input, const StepConditions& conditions) noexcept {
    if (!conditions.sampleFinite || (input.unconfirmed && input.present)) {
        return;
    }
    hand_.take(input.deviceThandle, input.reindex, conditions.clutch);
    if (conditions.recentre) {
        const HandShift shift = hand_.recentre(tool_.pose());
        stage_.shift(shift.by, shift.turn); // changes no force, because there is none
    }
}

ProxyStep HapticCycle::moveTool(const StepInput& input, const ContactSet* set,
                                const StepConditions& conditions, StepRecord& out) noexcept {
    ProxyStep moved;
    moved.minGap = kNotKnown;
    out.arm.posture = place().arm;
    if (conditions.movesTool) {
        ProxyInput wanted;
        wanted.target = hand_.springEnd();
        wanted.metricRadius = watch_.springs().metricRadius;
        wanted.contacts = set;
        wanted.deadline = input.deadline;
        wanted.surfaceMoved = conditions.newData && pressed_.any();
        moved = tool_.step(wanted, input.buttons, out.arm);
    } else {
        tool_.hold();
        moved.allowed = allowed_; // the last reaction fades out
    }
    if (tool_.freeDirection()) {
        // The hand's rotation has no meaning. It is set to the tip's, so no spring turns the hand, even while
        // the arm is held.
        moved.allowed.rotation = tool_.pose().rotation;
        hand_.turnTo(tool_.pose().rotation);
    }
    return moved;
}

SolvedStep HapticCycle::solved(const ProxyStep& moved, const ContactSet* set) const noexcept {
    return {moved, set, tool_, hand_.springEnd(), watch_.springs(), stage_.reaction()};
}

// If pressed regions vanished, the tool stays where it was before, and the hand with it. Otherwise the tool
// would jump at the hand, through what can no longer be seen. True if some did.
bool HapticCycle::keepHandAtTool(const ContactSet* set, const StepPoses& before, ProxyStep& moved) noexcept {
    const std::optional<VanishedRegions> gone = pressed_.vanished(solved(moved, set), before);
    if (!gone) {
        return false;
    }
    if (!moved.escape) { // else it had to leave
        tool_.putBack(before.tool, moved);
    }
    shifted(hand_.keepAt(tool_.pose(), *gone, before.allowed, moved));
    return true;
}

// The hand was re-indexed by `shift`.
void HapticCycle::shifted(const HandShift& shift) noexcept {
    stage_.shift(shift.by, shift.turn);
    tool_.setTarget(hand_.springEnd());
}

WrenchInput HapticCycle::wrenchInput(const StepInput& input, const StepConditions& conditions,
                                     const ProxyStep& moved) const noexcept {
    WrenchInput tick;
    tick.allowed = moved.allowed;
    tick.springEnd = hand_.springEnd();
    tick.device = hand_.device();
    tick.baseRhandle = hand_.baseRhandle();
    tick.springs = watch_.springs();
    tick.pull = hand_.pull(watch_.springs());
    tick.pushes = (moved.active.empty() && !moved.blocked ? 0 : cause::kRow) |
                  (tool_.jointLimits() == 0 ? 0 : cause::kJoint);
    const auto holds = [](const ActiveContact& c) { return c.row.kind == ContactRow::Kind::Equality; };
    tick.bothWays = !moved.active.empty() && std::ranges::all_of(moved.active, holds);
    tick.mayRise = !moved.rowsExpired && !input.unconfirmed;
    tick.newData = conditions.newData;
    tick.escape = moved.escape;
    tick.forcesOn = conditions.setReady && !conditions.off && !conditions.clutch;
    tick.off = conditions.off;
    tick.trapped = moved.trapped;
    tick.stale = conditions.stale;
    tick.sampleFinite = conditions.sampleFinite;
    tick.rendered = input.present;
    tick.elapsed = input.measuredPeriod > 0.0 ? input.measuredPeriod : options_.period;
    return tick;
}

void HapticCycle::makeWrench(const WrenchInput& input, StepRecord& out) noexcept {
    const WrenchStage::Output made = stage_.step(input);
    out.wrench = made.wrench;
    out.deviceWrench = hand_.toDevice(made.delivered);
    out.residual = made.residual;
    out.finite = made.finite;
    out.cause = made.cause;
}

} // namespace fathom
