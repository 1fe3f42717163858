// SPDX-License-Identifier: Apache-2.0
#include "engine/cycle/haptic_cycle.h"

#include "engine/haptics/limits.h"

#include <algorithm>
#include <cmath>

namespace fathom {
namespace {

// Ramps up by the nominal period and down by the measured one: late ticks cannot delay fading out and cannot
// make a force grow faster.
void ramp(double& value, bool up, double nominal, double measured, double whole) {
    value = std::clamp(value + (up ? nominal : -measured) / whole, 0.0, 1.0);
}

PassivityOptions passivityOf(const HapticOptions& options) {
    PassivityOptions passivity = makePassivity(options.device, options.springs, options.coupling,
                                               options.forceLimit, options.torqueLimit);
    passivity.delayTicks = options.deviceDelayTicks;
    return passivity;
}

// |part| / |whole|; 1 when `whole` is zero.
double shareOf(const dvec3& part, const dvec3& whole) {
    const double length = glm::length(whole);
    return length > 0.0 ? glm::length(part) / length : 1.0;
}

// The pose that the hand commands before the first step.
Pose begin(HandMap& map, const Pose& start, const Pose* tool0, const ArmRig* arm) {
    if (tool0 == nullptr) {
        return map.map(start, false);
    }
    const Pose tool = arm != nullptr ? arm->tipAt({arm->start, 0.0}) : *tool0;
    map.align(start, tool);
    return tool;
}

} // namespace

HapticCycle::HapticCycle(const Tool& tool, std::span<const Shape> shapes, const HapticOptions& options,
                         const Pose& start, const Pose* tool0, const ArmRig* arm)
    : options_(options)
    , map_(options.baseRdevice, options.handScale)
    , guidance_(options.guidance)
    , rig_(arm)
    , watch_(options.device, options.coupling, options.springs)
    , passivity_(passivityOf(options))
    , springEnd_(begin(map_, start, tool0, arm))
    , device_(springEnd_)
    , handle_{start.position, glm::normalize(start.rotation)}
    , deviceBefore_(device_) {
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
    toolBefore_ = tool_;
    springEnd_ = deviceBefore_ = device_ = arm != nullptr ? device_ : tool_;
}

StepRecord HapticCycle::step(const StepInput& input) noexcept {
    StepRecord out;
    out.t = input.time;
    Situation now;
    now.sane = isFinite(input.deviceThandle) && std::isfinite(input.time);
    now.off = input.forcesOff || (input.buttons & kDeadManOpen) != 0;
    const ContactSet* set = chooseSet(input, out);
    now.running = set != nullptr || !options_.needsContacts;
    out.frame = set != nullptr ? set->frame : now.running ? input.frame : -1;
    out.sceneAge = out.frame >= 0 ? sceneAge(input, set) : kNotKnown;
    now.stale = out.sceneAge > options_.staleAfter;
    now.held = followed_ && (!armFollows_ || !now.sane || now.off || !now.running || now.stale);
    now.clutch = (input.buttons & options_.clutchBit) != 0 || now.held;
    if (now.sane) {
        handle_ = {input.deviceThandle.position, glm::normalize(input.deviceThandle.rotation)};
        device_ = map_.map(handle_, now.clutch);
    }
    guidance_.step(input.guidance, device_, (input.buttons & kGuidanceButton) != 0,
                   now.off || !now.running || now.held, options_.period);

    ProxyStep moved;
    moved.minGap = kNotKnown;
    springEnd_ = device_;
    out.arm.posture = place().arm;
    if (now.running && now.sane && !now.held) {
        moved = moveTool(input, set, out);
    }
    freeDirection();
    held_ = now.held;
    const double period = input.measuredPeriod > 0.0 ? input.measuredPeriod : options_.period;
    stepRamps(now, moved.trapped, period);
    finishWrench(springWrench(), period, now, out);

    report(now, moved, set != nullptr, out);
    recordTouches(set, moved, out);
    holdArm(now, moved.trapped, out);
    fillMargins(input, out);
    watch_.step(input.measuredPeriod); // active from the next step on
    return out;
}

void HapticCycle::report(const Situation& now, const ProxyStep& moved, bool hasSet,
                         StepRecord& out) const noexcept {
    out.device = device_;
    out.tool = tool_;
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

void HapticCycle::stepRamps(const Situation& now, bool trapped, double measured) noexcept {
    const bool on = now.running && !now.off && !now.clutch;
    arming_ = (arming_ || now.off) && ramps_.power < 1.0;
    const double nominal = options_.period;
    ramp(ramps_.power, on, nominal, measured, on && arming_ ? options_.armTime : kRampTime);
    ramp(ramps_.free, !trapped, nominal, measured, kRampTime);
    ramp(ramps_.fresh, !now.stale, nominal, measured, kFadeTime);
}

Wrench HapticCycle::springWrench() noexcept {
    const Springs& springs = watch_.springs();
    const Pose& tool = tool_;
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

// The part of the spring wrench that guidance adds. It moves the hand on purpose, so the passivity controller
// excludes it.
Wrench HapticCycle::guidancePull() const noexcept {
    return options_.paperGuidance ? guidance_.pull(device_, watch_.springs())
                                  : couple(watch_.springs(), springEnd_, device_, dvec3(0.0), dvec3(0.0));
}

Wrench HapticCycle::onActuatedAxes(const Wrench& wrench) const noexcept {
    return projectOnAxes(wrench, map_.baseRhandle(handle_), options_.device.actuated).delivered;
}

Wrench HapticCycle::passivityWrench(const Wrench& spring, const Wrench& pull, double period) noexcept {
    if (!options_.passivityController) {
        return {};
    }
    PassivityStep tick;
    tick.device = device_;
    tick.end = springEnd_;
    tick.contact = onActuatedAxes({spring.force - pull.force, spring.torque - pull.torque});
    tick.share = ramps_.product();
    tick.springs = watch_.springs();
    tick.period = period;
    return passivity_.step(tick);
}

// Subtracts the guidance share of the delivered wrench, scaled as the size limit scaled it.
void HapticCycle::tellPassivity(const Wrench& pull, const Wrench& damper, const Wrench& asked,
                                const Wrench& sized, const Wrench& delivered) noexcept {
    const double ramp = ramps_.product();
    const double force = shareOf(sized.force, asked.force), torque = shareOf(sized.torque, asked.torque);
    const Wrench guided = onActuatedAxes({ramp * force * pull.force, ramp * torque * pull.torque});
    const Wrench damped = onActuatedAxes({force * damper.force, torque * damper.torque});
    passivity_.delivered(
        {delivered.force - guided.force - damped.force, delivered.torque - guided.torque - damped.torque},
        damped);
}

void HapticCycle::finishWrench(const Wrench& spring, double period, const Situation& now,
                               StepRecord& out) noexcept {
    smooth_ = lowPass(scaled(spring, ramps_.product()), smooth_, options_.lowPassGain);
    const Wrench pull = guidancePull();
    const Wrench damper = passivityWrench(spring, pull, period);
    const Wrench asked{smooth_.force + damper.force, smooth_.torque + damper.torque};
    const Wrench sized = limitSize(asked, options_.forceLimit, options_.torqueLimit);
    out.wrench = limitSlew(sized, previous_, options_.slewForce * options_.period,
                           options_.slewTorque * options_.period);
    out.finite = now.sane && isFinite(out.wrench);
    if (!out.finite) {
        out.wrench = smooth_ = {};
        passivity_.reset();
        ++notFinite_;
    }
    previous_ = out.wrench;
    const auto projected = projectOnAxes(out.wrench, map_.baseRhandle(handle_), options_.device.actuated);
    out.deviceWrench = map_.toDevice(projected.delivered);
    out.residual = projected.residual;
    tellPassivity(pull, damper, asked, sized, projected.delivered);
}

StepState HapticCycle::stateOf(const Situation& now, const ProxyStep& moved) const noexcept {
    if (!now.running) {
        return StepState::Off;
    }
    if (now.off || now.held) {
        return ramps_.power > 0.0 ? StepState::Fading : StepState::Off;
    }
    if (moved.trapped) {
        return StepState::Trapped;
    }
    if (now.stale) {
        return StepState::Fading;
    }
    if (moved.escape) {
        return StepState::Escape;
    }
    return moved.contact ? StepState::Contact : StepState::Free;
}

// An arm stands still while anything is wrong, and then until tool and hand meet again or are re-indexed.
// When a real arm follows, the tool never left it.
void HapticCycle::holdArm(const Situation& now, bool trapped, StepRecord& out) noexcept {
    const bool wrong =
        !now.sane || !now.running || now.off || now.stale || trapped || !out.finite || now.held;
    const bool met =
        now.clutch || followed_ || glm::distance(out.tool.position, out.device.position) <= kResumeWithin;
    armHold_ = wrong || (armHold_ && !met);
    out.armHold = armHold_;
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
