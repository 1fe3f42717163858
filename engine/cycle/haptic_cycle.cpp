// SPDX-License-Identifier: Apache-2.0
#include "engine/cycle/haptic_cycle.h"

#include "engine/haptics/limits.h"

#include <algorithm>
#include <cmath>

namespace fathom {
namespace {

void step(double& ramp, bool up, double change) {
    ramp = std::clamp(ramp + (up ? change : -change), 0.0, 1.0);
}

} // namespace

HapticCycle::HapticCycle(const Tool& tool, std::span<const Shape> shapes, const HapticOptions& options,
                         const Pose& start)
    : options_(options)
    , map_(options.baseRdevice, options.handScale)
    , guidance_(options.guidance)
    , proxy_(tool, shapes, options.proxy, map_.map(start, false))
    , device_(proxy_.pose())
    , handle_(start)
    , toolBefore_(device_)
    , deviceBefore_(device_) {}

TurnRecord HapticCycle::turn(const TurnInput& input) noexcept {
    TurnRecord out;
    out.t = input.time;
    Situation now;
    now.sane = isFinite(input.deviceThandle) && std::isfinite(input.time);
    now.off = input.forcesOff || (input.buttons & kDeadManOpen) != 0;
    now.clutch = (input.buttons & options_.clutchBit) != 0;
    if (now.sane) {
        handle_ = input.deviceThandle;
        device_ = map_.map(handle_, now.clutch);
    }
    const ContactSet* set = chooseSet(input, out);
    now.running = set != nullptr || !options_.needsContacts;
    out.frame = set != nullptr ? set->frame : now.running ? input.frame : -1;
    out.sceneAge = out.frame >= 0 ? sceneAge(input, set) : kNotKnown;
    now.stale = out.sceneAge > options_.staleAfter;
    guidance_.step(input.guidance, device_, (input.buttons & kGuidanceButton) != 0, now.off || !now.running,
                   options_.period);

    ProxyTurn moved;
    moved.minGap = kNotKnown;
    if (now.running && now.sane) {
        moved = moveTool(input, set);
    }
    stepRamps(now, moved.trapped);
    finishWrench(springWrench(), now, out);

    report(now, moved, set != nullptr, out);
    holdArm(now, moved.trapped, out);
    fillMargins(input, out);
    return out;
}

void HapticCycle::report(const Situation& now, const ProxyTurn& moved, bool hasSet,
                         TurnRecord& out) const noexcept {
    out.device = device_;
    out.tool = proxy_.pose();
    out.contacts = static_cast<uint32_t>(moved.active.size());
    out.minGap = hasSet ? moved.minGap : kNotKnown;
    out.state = stateOf(now, moved);
    out.guidance = guidance_.weight();
    out.guidanceClass = guidance_.chosen();
    out.guidanceTarget = guidance_.target();
    out.stalled = moved.stalled;
    out.solves = moved.solves;
    out.infeasible = moved.infeasible;
}

const ContactSet* HapticCycle::chooseSet(const TurnInput& input, TurnRecord& out) noexcept {
    const ContactSet* offered = input.offered;
    if (offered != nullptr && offered->frame >= 0 && proxy_.covers(*offered)) {
        out.adopted = true;
        return offered;
    }
    return input.contacts != nullptr && input.contacts->frame >= 0 ? input.contacts : nullptr;
}

double HapticCycle::sceneAge(const TurnInput& input, const ContactSet* set) noexcept {
    // The set in force may be older than the newest fixture set; while it is the same one, the picture may be
    // newer.
    const bool newest = set == nullptr || set->generation == input.generation;
    const double age = input.time - (newest ? input.captureTime : set->captureTime);
    age_ = input.sourceEnded && hasAge_ ? std::min(age, age_) : age;
    hasAge_ = true;
    return age_;
}

ProxyTurn HapticCycle::moveTool(const TurnInput& input, const ContactSet* set) noexcept {
    ProxyInput wanted;
    wanted.target = device_;
    wanted.metricRadius = options_.springs.metricRadius;
    wanted.contacts = set;
    wanted.deadline = input.deadline;
    if (!options_.paperGuidance) {
        // The turn is composed, not added to log(q_dev q^-1): the same to first order, and at rest the torque
        // is exactly K_r times the lead.
        const auto lead = guidance_.lead(device_, options_.springs);
        wanted.target.position += lead.translation;
        if (lead.rotation != dvec3(0.0)) {
            wanted.target.rotation = glm::normalize(rotationExp(lead.rotation) * device_.rotation);
        }
    }
    return proxy_.turn(wanted);
}

void HapticCycle::stepRamps(const Situation& now, bool trapped) noexcept {
    step(ramps_.power, now.running && !now.off && !now.clutch, options_.period / kRampTime);
    step(ramps_.free, !trapped, options_.period / kRampTime);
    step(ramps_.fresh, !now.stale, options_.period / kFadeTime);
}

Wrench HapticCycle::springWrench() noexcept {
    const Springs& springs = options_.springs;
    const Pose& tool = proxy_.pose();
    dvec3 slip(0.0), spin(0.0);
    if (springs.damping != 0.0 || springs.rotationalDamping != 0.0) {
        const dvec3 toolMoved = tool.position - toolBefore_.position,
                    handMoved = device_.position - deviceBefore_.position;
        const dvec3 toolTurned = rotationLog(tool.rotation * glm::conjugate(toolBefore_.rotation));
        const dvec3 handTurned = rotationLog(device_.rotation * glm::conjugate(deviceBefore_.rotation));
        slip = (toolMoved - handMoved) / options_.period;
        spin = (toolTurned - handTurned) / options_.period;
    }
    toolBefore_ = tool;
    deviceBefore_ = device_;
    Wrench wrench = couple(springs, tool, device_, slip, spin);
    if (options_.paperGuidance) {
        const Wrench pull = guidance_.pull(device_, springs);
        wrench.force += pull.force;
        wrench.torque += pull.torque;
    }
    return wrench;
}

void HapticCycle::finishWrench(const Wrench& spring, const Situation& now, TurnRecord& out) noexcept {
    const Wrench wanted = scaled(spring, ramps_.product());
    smooth_ = lowPass(wanted, smooth_, options_.lowPassGain);
    const Wrench sized = limitSize(smooth_, options_.forceLimit, options_.torqueLimit);
    out.wrench = limitSlew(sized, previous_, options_.slewForce * options_.period,
                           options_.slewTorque * options_.period);
    out.finite = now.sane && isFinite(out.wrench);
    if (!out.finite) {
        out.wrench = smooth_ = {};
        ++notFinite_;
    }
    previous_ = out.wrench;
    const auto projected = projectOnAxes(out.wrench, map_.baseRhandle(handle_), options_.device.actuated);
    out.deviceWrench = map_.toDevice(projected.delivered);
    out.residual = projected.residual;
}

TurnState HapticCycle::stateOf(const Situation& now, const ProxyTurn& moved) const noexcept {
    if (!now.running) {
        return TurnState::Off;
    }
    if (now.off) {
        return ramps_.power > 0.0 ? TurnState::Fading : TurnState::Off;
    }
    if (moved.trapped) {
        return TurnState::Trapped;
    }
    if (now.stale) {
        return TurnState::Fading;
    }
    if (moved.escape) {
        return TurnState::Escape;
    }
    return moved.contact ? TurnState::Contact : TurnState::Free;
}

// An arm stands still while anything is wrong, and after that until tool and hand have met again or were
// re-indexed.
void HapticCycle::holdArm(const Situation& now, bool trapped, TurnRecord& out) noexcept {
    const bool wrong = !now.sane || !now.running || now.off || now.stale || trapped || !out.finite;
    const bool met = now.clutch || glm::distance(out.tool.position, out.device.position) <= kResumeWithin;
    armHold_ = wrong || (armHold_ && !met);
    out.armHold = armHold_;
}

void HapticCycle::fillMargins(const TurnInput& input, TurnRecord& out) const noexcept {
    CouplingOptions live = options_.coupling;
    if (input.measuredPeriod > 0.0) {
        live.period = input.measuredPeriod;
    }
    const auto margins = stabilityMargins(options_.device, options_.springs, live);
    out.marginPassive = margins.passive.value_or(kNotKnown);
    out.marginUncoupled = margins.uncoupled.value_or(kNotKnown);
}

} // namespace fathom
