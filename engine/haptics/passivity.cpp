// SPDX-License-Identifier: Apache-2.0
#include "engine/haptics/passivity.h"

#include "engine/haptics/limits.h"

#include <algorithm>
#include <cmath>

namespace fathom {
namespace {

double workOf(const Wrench& wrench, const dvec3& moved, const dvec3& turned) {
    return glm::dot(wrench.force, moved) + glm::dot(wrench.torque, turned);
}

// Energy [J] whose gradient is min(gain x pull, limit): a spring up to the limit, a constant pull beyond it.
double energyOf(double pull, double stiffness, double gain, double limit) {
    if (!(stiffness > 0.0) || !(gain > 0.0)) {
        return 0.0;
    }
    const double force = gain * pull;
    return force <= limit ? force * pull / (2.0 * stiffness)
                          : limit * pull / stiffness - limit * limit / (2.0 * stiffness * gain);
}

constexpr double kNoLimit = 1e300;

struct Damping {
    double anyMotion = 0.0, alongReaction = 0.0; // [N s/m]
};
struct Push { // of the springs, as a force or a torque
    dvec3 sent, now;
};

// The force against a motion and its part along the reaction. A push that moves the hand out becomes weaker,
// and never a pull. `weight`: of the motion in the metric.
dvec3 damped(Damping d, const dvec3& motion, const dvec3& part, const Push& push, double weight = 1.0) {
    const double square = weight * glm::dot(part, part);
    if (glm::dot(push.sent, motion) > 0.0 && square > 0.0) {
        const double most = std::max(0.0, glm::dot(push.now, motion)) / square;
        d.anyMotion = std::min(d.anyMotion, most);
        d.alongReaction = std::min(d.alongReaction, most - d.anyMotion);
    }
    return -(d.anyMotion * motion + d.alongReaction * part);
}

} // namespace

PassivityOptions makePassivity(const DevicePreset& preset, const Springs& springs,
                               const CouplingOptions& coupling) {
    PassivityOptions options;
    const double scale = coupling.handScale;
    // The hand moves 1/s of the tool's motion, and its energies count s times at the tool (hand_map.h).
    options.damping = preset.damping.value_or(preset.stiffness * kPresetPeriod / 2.0) / scale;
    options.rotationalDamping = preset.rotationalDamping ? *preset.rotationalDamping * scale
                                                         : springs.rotationalStiffness * coupling.period *
                                                               (1.0 + 2.0 * coupling.delayTicks) / 2.0;
    options.metricRadius = springs.metricRadius;
    options.actuated = preset.actuated;
    return options;
}

PassivityController::PassivityController(const PassivityOptions& options)
    : options_(options) {
    options_.delayTicks = std::min<uint32_t>(options_.delayTicks, kMaxDelay);
}

void PassivityController::reset() noexcept {
    applied_.fill({});
    credit_.fill(0.0);
    recent_ = stored_ = debt_ = dataDebt_ = given_ = 0.0;
    started_ = false;
}

double PassivityController::storedIn(const PassivityStep& tick, const Ramp& ramp) const noexcept {
    return energyOf(glm::length(tick.contact.force), tick.springs.stiffness, ramp.gain, ramp.force) +
           energyOf(glm::length(tick.contact.torque), tick.springs.rotationalStiffness, ramp.gain,
                    ramp.torque);
}

// [J] that the springs would hold in addition without fades and limits.
double PassivityController::heldBack(const PassivityStep& tick) const noexcept {
    return std::max(0.0, storedIn(tick, {1.0, kNoLimit, kNoLimit}) - stored_);
}

void PassivityController::begin(const PassivityStep& tick) noexcept {
    stored_ = storedIn(tick, {tick.fadeGain, tick.forceLimit, tick.torqueLimit});
    given_ = std::clamp(given_ - stored_, 0.0, heldBack(tick));
}

// Forces have faded out: only the hand's account remains.
void PassivityController::rest(const PassivityStep& tick) noexcept {
    const double given = given_ + std::max(0.0, stored_ - std::max(0.0, debt_));
    reset();
    given_ = std::min(given, heldBack(tick));
}

void PassivityController::shift(const dvec3& by, const dquat& turn) noexcept {
    device_ = {device_.position + by, turn * device_.rotation};
    springEnd_ = {springEnd_.position + by, turn * springEnd_.rotation};
}

void PassivityController::giveUpWithoutRows(const PassivityStep& tick) noexcept {
    timeWithoutRows_ = tick.rows ? 0.0 : timeWithoutRows_ + tick.elapsed;
    if (timeWithoutRows_ > kFreeTime && debt_ > 0.0) {
        debt_ = 0.0;
    }
}

// The part of a motion along actuated axes: `force` its translation, `torque` its rotation.
Wrench PassivityController::actuated(const PassivityStep& tick, const dvec3& moved,
                                     const dvec3& turned) const noexcept {
    return projectOnAxes({moved, turned}, tick.baseRhandle, options_.actuated).delivered;
}

void PassivityController::observe(const PassivityStep& tick) noexcept {
    const dvec3 endMoved = tick.springEnd.position - springEnd_.position,
                endTurned = rotationBetween(springEnd_.rotation, tick.springEnd.rotation);
    moved_ = tick.device.position - device_.position;
    turned_ = rotationBetween(device_.rotation, tick.device.rotation);
    // The oldest entry of the ring: the wrench that acted on the hand in the interval that ends now.
    const Applied& acted = applied_[writes_ % (options_.delayTicks + 1)];
    const double damped = -workOf(acted.damper, moved_, turned_);
    const Ramp ramp{tick.fadeGain, tick.forceLimit, tick.torqueLimit};
    const double stored = storedIn(tick, ramp);
    const double ramped = ramp == ramp_ ? 0.0 : stored - storedIn(tick, ramp_); // by fades and returns
    const auto [actuatedMoved, actuatedTurned] =
        actuated(tick, endMoved, endTurned); // a wrist without a motor dissipates nothing
    const double credit = (options_.damping * glm::dot(actuatedMoved, actuatedMoved) +
                           options_.rotationalDamping * glm::dot(actuatedTurned, actuatedTurned)) /
                          tick.elapsed;
    const double fromHand = std::min(ramped, given_); // negative while forces fade
    const double generatedNow =
        workOf(acted.contact, endMoved, endTurned) + stored - stored_ - credit - fromHand;
    generated_ += std::max(0.0, generatedNow);
    dissipated_ += damped;
    stored_ = stored;
    given_ -= fromHand;
    rememberCredit(credit);
    debt_ = std::max(debt_ + generatedNow - damped, -recent_);
    settle(tick, generatedNow, fromHand);
}

// After the debt of a tick is known. What a fade took pays the debt first, and only the rest is the hand's.
void PassivityController::settle(const PassivityStep& tick, double generated, double fromHand) noexcept {
    if (fromHand < 0.0) {
        const double paid = std::min(-fromHand, std::max(0.0, debt_));
        debt_ -= paid;
        given_ -= paid;
    }
    given_ = given_ > 0.0 ? std::min(given_, heldBack(tick)) : 0.0;
    const double excess = std::max(0.0, debt_ - stored_), kept = std::exp(-tick.elapsed / kForget);
    debt_ -= (1.0 - kept) * excess;
    const bool paced = tick.appears || fromHand > 0.0;
    dataDebt_ =
        std::clamp((excess > 0.0 ? kept : 1.0) * (dataDebt_ + (paced ? std::max(0.0, generated) : 0.0)), 0.0,
                   std::max(0.0, debt_));
}

void PassivityController::rememberCredit(double credit) noexcept {
    double& slot = credit_[ticks_++ % kWindow];
    slot = credit;
    recent_ = 0.0;
    for (const double c :
         credit_) { // summed again: a running sum would accumulate the rounding of fast ticks
        recent_ += c;
    }
}

// [N s/m] What a hand that moves out gets back from the springs is dissipated in proportion, so that the debt
// is repaid when they are empty: the hand never leaves faster than it came. `returned` [W]; `pushed`: square
// of the speed along the reaction.
double PassivityController::release(const PassivityStep& tick, double returned, double pushed,
                                    double owed) const noexcept {
    if (!(returned > 0.0) || !(pushed > 0.0)) {
        return 0.0;
    }
    const double owes = owed / std::max(owed, stored_),
                 braked = std::clamp(2.0 * (owes - kMinDebtRatio), 0.0, owes);
    return std::min(braked * returned / pushed,
                    kMaxRelease / (tick.elapsed * (1.0 + 2.0 * options_.delayTicks)));
}

// What new data generated is dissipated by motion along the reaction alone: a hand that slides is not braked.
// Motion of a hand at rest is all damped, which calms a light hand on a noisy surface.
PassivityController::Power PassivityController::power(const PassivityStep& tick, double owed,
                                                      double speed) const noexcept {
    const double fromData = std::min(dataDebt_, owed), paced = fromData / std::max(tick.elapsed, tick.repay);
    const double slides = std::clamp(speed / kRestingSpeed - 1.0, 0.0, 1.0);
    return {(owed - fromData) / tick.elapsed + (1.0 - slides) * paced, slides * paced};
}

Wrench PassivityController::control(const PassivityStep& tick) const noexcept {
    const double owed = debt_ - kTolerance;
    if (!(owed > 0.0)) {
        return {};
    }
    auto [v, w] = actuated(tick, moved_ / tick.elapsed, turned_ / tick.elapsed);
    v = glm::length(v) < kMinSpeed ? dvec3(0.0) : v;
    w = glm::length(w) < kMinTurnSpeed ? dvec3(0.0) : w;
    const double kk = options_.metricRadius * options_.metricRadius;
    const double speed = glm::dot(v, v) + kk * glm::dot(w, w);
    if (!(speed > 0.0)) {
        return {};
    }
    const double most = std::min(kMaxDamping * std::min(options_.damping, options_.rotationalDamping / kk),
                                 kMaxImpulse / (tick.elapsed * (1.0 + 2.0 * options_.delayTicks)));
    const Power p = power(tick, owed, std::sqrt(speed));
    const Wrench& acting = newest();
    const dvec3 vn = projectedOn(v, acting.force), wn = projectedOn(w, acting.torque);
    const double pushed = glm::dot(vn, vn) + kk * glm::dot(wn, wn);
    Damping d;
    d.anyMotion = std::min(p.anyMotion / speed, most);
    d.alongReaction = pushed > 0.0 ? std::min(p.alongReaction / pushed, most - d.anyMotion) : 0.0;
    d.alongReaction =
        std::max(d.alongReaction, release(tick, workOf(acting, v, w), pushed, owed) - d.anyMotion);
    Wrench damper{tick.fadeGain * damped(d, v, vn, {acting.force, tick.contact.force}),
                  tick.fadeGain * kk * damped(d, w, wn, {acting.torque, tick.contact.torque}, kk)};
    if (!tick.rows) {
        const double left = std::clamp((kFreeTime - timeWithoutRows_) / kFreeEnd, 0.0, 1.0) * kFreeDamper,
                     size = std::sqrt(glm::dot(damper.force, damper.force) +
                                      glm::dot(damper.torque, damper.torque) / kk);
        const double part = size > left ? left / size : 1.0;
        damper = {part * damper.force, part * damper.torque};
    }
    return damper;
}

Wrench PassivityController::step(const PassivityStep& tick) noexcept {
    if (!(tick.elapsed > 0.0) || !isFinite(tick.device) || !isFinite(tick.springEnd)) {
        reset();
        return {};
    }
    if (!(tick.fadeGain > 0.0)) {
        rest(tick);
        return {};
    }
    Wrench damper;
    if (started_) {
        observe(tick);
        giveUpWithoutRows(tick);
        damper = control(tick);
    } else {
        begin(tick);
    }
    started_ = true;
    ramp_ = {tick.fadeGain, tick.forceLimit, tick.torqueLimit};
    device_ = tick.device;
    springEnd_ = tick.springEnd;
    if (!std::isfinite(debt_) || !std::isfinite(stored_)) {
        reset();
        return {};
    }
    return damper;
}

void PassivityController::delivered(const Wrench& contact, const Wrench& damper) noexcept {
    applied_[writes_ % (options_.delayTicks + 1)] = {contact, damper};
    ++writes_;
}

} // namespace fathom
