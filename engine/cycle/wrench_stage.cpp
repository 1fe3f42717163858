// SPDX-License-Identifier: Apache-2.0
#include "engine/cycle/wrench_stage.h"

#include "engine/haptics/wrench_metric.h"

#include <algorithm>

namespace fathom {
namespace {

constexpr double kCalmTurn = 0.2;   // share of the wanted wrench: 11 degrees
constexpr double kFastSlew = 4.0;   // times the rate of a ramp; the default slew limits are faster
constexpr double kRounding = 1e-12; // relative
constexpr double kNoTail = 1e-10;   // [N], [N m] less is rounding

PassivityOptions passivityOf(const HapticOptions& options) {
    PassivityOptions passivity = makePassivity(options.device, options.springs, options.coupling);
    passivity.delayTicks = options.deviceDelayTicks;
    return passivity;
}

// |part| / |whole|; 1 when `whole` is zero.
double shareOf(const dvec3& part, const dvec3& whole) {
    const double length = glm::length(whole);
    return length > 0.0 ? glm::length(part) / length : 1.0;
}

// A damper of a region brakes and holds nothing: against the reaction it is at most as large.
dvec3 damped(const dvec3& moved, const dvec3& reaction, double damping, bool bothWays) {
    const dvec3 force = projectedOn(-moved, reaction) * damping;
    const bool holds = !bothWays && glm::dot(force, reaction) < 0.0;
    return holds ? clampLength(force, glm::length(reaction)) : force;
}

// The output of the low-pass, in which the part that is no longer wanted shrinks by at least `step` per tick.
// Small changes of direction are left to the filter.
dvec3 withEndingTail(const dvec3& wanted, const dvec3& before, const dvec3& filtered, double step) {
    const double size = glm::length(wanted);
    const dvec3 sized = clampLength(filtered, std::max(size, glm::length(before) - step));
    const dvec3 kept = wantedPart(sized, wanted);
    const double calm = glm::dot(sized, wanted) < 0.0 ? 0.0 : kCalmTurn * size;
    const double tail = glm::length(before - wantedPart(before, wanted)) - step;
    return kept + clampLength(sized - kept, std::max(calm, tail));
}

// True if `felt` is more than the pull of guidance, in size or in another direction: what pushed before
// fades.
bool hasTail(const dvec3& felt, const dvec3& pull) {
    const double size = glm::length(pull);
    return glm::length(felt) > size + kNoTail ||
           glm::length(felt - wantedPart(felt, pull)) > kCalmTurn * size + kNoTail;
}

} // namespace

WrenchStage::WrenchStage(const HapticOptions& options)
    : options_(options)
    , passivity_(passivityOf(options)) {}

void WrenchStage::shift(const dvec3& by, const dquat& turn) noexcept {
    reaction_.shift(by, turn);
    passivity_.shift(by, turn);
    deviceBefore_ = {deviceBefore_.position + by, turn * deviceBefore_.rotation};
}

void WrenchStage::stepRamps(const WrenchInput& input) noexcept {
    softStart_ = (softStart_ || input.off) && (ramps_.active() || input.off);
    const auto fractionOf = [](const dvec3& v, double limit) {
        return limit > 0.0 ? glm::length(v) / limit : 0.0;
    };
    const double rendered = std::max(fractionOf(previous_.force, options_.forceLimit),
                                     fractionOf(previous_.torque, options_.torqueLimit));
    ramps_.step({input.forcesOn, !input.trapped, !input.stale}, options_.period, input.elapsed, rendered,
                softStart_ ? options_.softStartTime : ForceRamps::kRampTime);
}

// Acts along the reaction only: a hand that moves freely along a region is not braked. It brakes the hand
// against the ground, not against the tool, which new data may move by 2 mm in a tick.
Wrench WrenchStage::damping(const WrenchInput& input, const Wrench& reaction) noexcept {
    const Springs& springs = input.springs;
    Wrench wrench;
    if (springs.damping != 0.0 || springs.rotationalDamping != 0.0) {
        const double elapsed = std::max(options_.period, input.elapsed); // a late tick covers a longer motion
        const dvec3 moved = input.device.position - deviceBefore_.position;
        const dvec3 spun = rotationBetween(deviceBefore_.rotation, input.device.rotation);
        wrench.force = damped(moved, reaction.force, springs.damping / elapsed, input.bothWays);
        wrench.torque = damped(spun, reaction.torque, springs.rotationalDamping / elapsed, input.bothWays);
    }
    deviceBefore_ = input.device;
    return wrench;
}

Wrench WrenchStage::springWrench(const WrenchInput& input) noexcept {
    ReactionInput tick;
    tick.allowed = input.allowed;
    tick.springEnd = input.springEnd;
    tick.springs = input.springs;
    tick.period = options_.period;
    tick.elapsed = input.elapsed;
    tick.mayRise = input.mayRise && !input.trapped;
    tick.newData = input.newData;
    tick.vanished = input.vanished;
    tick.lags = input.lags;
    tick.forceLimit = ramps_.limitScale() * options_.forceLimit;
    tick.torqueLimit = ramps_.limitScale() * options_.torqueLimit;
    tick.rendered = metricSize(previous_, input.springs.metricRadius);
    return reaction_.step(tick);
}

Wrench WrenchStage::onActuatedAxes(const WrenchInput& input, const Wrench& wrench) const noexcept {
    return projectOnAxes(wrench, input.baseRhandle, options_.device.actuated).delivered;
}

Wrench WrenchStage::passivityWrench(const WrenchInput& input, const Wrench& reaction) noexcept {
    if (!options_.passivityController) {
        return {};
    }
    PassivityStep tick;
    tick.device = input.device;
    tick.springEnd = input.springEnd;
    tick.baseRhandle = input.baseRhandle;
    tick.contact = onActuatedAxes(input, reaction); // damping stores no energy
    tick.fadeGain = ramps_.fadeGain();
    tick.springs = input.springs;
    tick.elapsed = input.elapsed;
    tick.rows = input.pushes != 0 || reaction_.size() > kMinFelt; // without what fades: that holds nothing
    tick.forceLimit = ramps_.limitScale() * options_.forceLimit;
    tick.torqueLimit = ramps_.limitScale() * options_.torqueLimit;
    // Whatever a tick generates in which new data moves the tool comes from the new data. A lever gives back
    // as a force what the hand put in as a torque that the device does not render, and so does an arm at the
    // limit of a joint: that is no new energy, but cannot be distinguished from it.
    const bool lever = glm::length(reaction.torque - tick.contact.torque) > kMinFelt ||
                       glm::length(reaction.torque) > tick.torqueLimit || (input.pushes & cause::kJoint) != 0;
    tick.appears = reaction_.appears() || input.newData || input.escape || lever;
    tick.repay = reaction_.frameInterval();
    if (ramps_.off()) { // meanwhile the hand may go anywhere
        passivity_.reset();
    }
    return passivity_.step(tick);
}

// Reports the delivered wrench without guidance and damper, each scaled as the size limit scaled it.
void WrenchStage::reportToPassivity(const WrenchInput& input, const Wrench& damper, const Wrench& requested,
                                    const Wrench& sized, const Wrench& delivered) noexcept {
    const double ramp = ramps_.fadeGain();
    const Wrench& pull = input.pull;
    const double force = shareOf(sized.force, requested.force),
                 torque = shareOf(sized.torque, requested.torque);
    const Wrench guided = onActuatedAxes(input, {ramp * force * pull.force, ramp * torque * pull.torque});
    const Wrench damped = onActuatedAxes(input, {force * damper.force, torque * damper.torque});
    passivity_.delivered(
        {delivered.force - guided.force - damped.force, delivered.torque - guided.torque - damped.torque},
        damped);
}

uint32_t WrenchStage::causeOf(const WrenchInput& input, const Wrench& damper, const Wrench& sized,
                              const Wrench& slewed) const noexcept {
    const Wrench& pull = input.pull;
    const bool tail = isZero(pull)
                          ? !isZero(smooth_)
                          : hasTail(smooth_.force, pull.force) || hasTail(smooth_.torque, pull.torque);
    const bool fades = ramps_.active() || reaction_.fades() || (input.pushes == 0 && tail);
    const bool held = slewed.force != sized.force || slewed.torque != sized.torque;
    return input.pushes | (isZero(pull) ? 0 : cause::kGuidance) | (isZero(damper) ? 0 : cause::kDamping) |
           (fades ? cause::kRamp : 0) | (held ? cause::kSlew : 0);
}

void WrenchStage::cut() noexcept {
    previous_ = smooth_ = {};
    ramps_.cut();
    passivity_.reset();
}

// After one tick. What is no longer wanted ends within a ramp, also with a low slew limit or late ticks. A
// fast slew limit ends it soon enough by itself: then no step is larger than that, however late a tick is.
dvec3 WrenchStage::slewed(const dvec3& wanted, const dvec3& before, double slew, double limit,
                          double elapsed) const noexcept {
    const double rise = options_.period * slew, ramp = limit / ForceRamps::kRampTime;
    const double fall = slew >= kFastSlew * ramp ? rise : std::max(options_.period, elapsed) * ramp;
    const dvec3 next = limitSlew(wanted, before, rise, fall);
    // The slew limit must not delay the end of a ramp. A force that turned as well would change by more.
    const double most = std::max(ramps_.fadeGain() * limit, glm::length(before) - fall);
    return glm::length(next) > most * (1.0 + kRounding) ? clampLength(before, most) : next;
}

// The low-pass of the wanted wrench. However slow the filter is, what is no longer wanted ends within a ramp.
Wrench WrenchStage::smoothed(const WrenchInput& input, const Wrench& wanted) noexcept {
    if (options_.lowPassGain >= 1.0) {
        return smooth_ = wanted;
    }
    const double rampStep = std::max(options_.period, input.elapsed) / ForceRamps::kRampTime;
    const Wrench filtered = lowPass(wanted, smooth_, options_.lowPassGain);
    const double inForce = std::min(ramps_.limitScale(), ramps_.fadeGain());
    const auto ending = [&](const dvec3& now, const dvec3& before, const dvec3& after, double limit) {
        // No more than was felt: what is no longer wanted must not rise with the limits.
        const double felt = std::max(glm::length(now), inForce * limit);
        return withEndingTail(now, clampLength(before, felt), after, rampStep * limit);
    };
    smooth_ = {ending(wanted.force, smooth_.force, filtered.force, options_.forceLimit),
               ending(wanted.torque, smooth_.torque, filtered.torque, options_.torqueLimit)};
    return smooth_ = ramps_.off() ? Wrench{} : smooth_;
}

WrenchStage::Output WrenchStage::step(const WrenchInput& input) noexcept {
    stepRamps(input);
    const Wrench reaction = springWrench(input);
    const Wrench contact = sumOf(reaction, damping(input, reaction));
    const Wrench wanted = sumOf(contact, input.pull);
    const Wrench smooth = scaled(smoothed(input, wanted), ramps_.fadeGain());
    const Wrench damper = passivityWrench(input, reaction);
    const Wrench requested = sumOf(smooth, damper);
    // A ramp is felt from its beginning, also where the spring is beyond the limits.
    const double limitScale = std::min(ramps_.limitScale(), ramps_.fadeGain());
    const Wrench sized =
        limitSize(requested, limitScale * options_.forceLimit, limitScale * options_.torqueLimit);
    Output out;
    out.wrench.force =
        slewed(sized.force, previous_.force, options_.slewForce, options_.forceLimit, input.elapsed);
    out.wrench.torque =
        slewed(sized.torque, previous_.torque, options_.slewTorque, options_.torqueLimit, input.elapsed);
    out.cause = causeOf(input, damper, sized, out.wrench);
    out.finite = input.sampleFinite && isFinite(out.wrench);
    notFinite_ += out.finite ? 0 : 1;
    if (!isFinite(out.wrench)) {
        reaction_ = {}; // what it remembers is not finite, either
    }
    if (!out.finite || !input.rendered) {
        cut();
        out.wrench = {};
    }
    previous_ = out.wrench;
    const auto projected = projectOnAxes(out.wrench, input.baseRhandle, options_.device.actuated);
    out.delivered = projected.delivered;
    out.residual = projected.residual;
    reportToPassivity(input, damper, requested, sized, projected.delivered);
    return out;
}

} // namespace fathom
