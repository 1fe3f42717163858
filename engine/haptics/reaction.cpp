// SPDX-License-Identifier: Apache-2.0
#include "engine/haptics/reaction.h"

#include "engine/haptics/limits.h"

#include <algorithm>
#include <cmath>

namespace fathom {

namespace {

constexpr double kMinRiseRate = 10.0;   // [N/s] after new data
constexpr double kRoundingForce = 1e-6; // [N] rounding
constexpr double kPushTime = 0.012;     // [s] in which new data pushes a tool out, or half a frame
constexpr double kFrameSlack = 1.25;    // frame intervals to wait for the next frame
constexpr double kMinMixLength = 0.3;   // directions that differ more than that are not mixed
constexpr double kTurnedLoss = 2.0;     // [N] a larger loss that turns the reaction fades
constexpr double kHeldShare = 0.05;     // of held_, added to a small spring: it would end held_ at once
constexpr double kSameDirection = 0.8;  // cosine between a reaction and the former one, which it continues

} // namespace

void Reaction::shift(const dvec3& by, const dquat& turn) noexcept {
    end_ = {end_.position + by, turn * end_.rotation};
}

void Reaction::keepTime(const ReactionInput& input) noexcept {
    elapsed_ = std::max(input.period, input.elapsed);
    sinceData_ += elapsed_;
    if (input.newData) {
        interval_ = std::clamp(sinceData_, input.period, kLongestFrame);
        sinceData_ = 0.0;
        riseRate_ = kMinRiseRate;
    }
}

Reaction::Travel Reaction::travelOf(const Pose& end) noexcept {
    const Pose before = started_ ? end_ : end;
    end_ = end;
    started_ = true;
    Travel travel{end.position - before.position, rotationBetween(before.rotation, end.rotation), 0.0};
    travel.length =
        std::sqrt(glm::dot(travel.moved, travel.moved) + glm::dot(k_ * travel.turned, k_ * travel.turned));
    return travel;
}

// The newest data may still be moving the tool.
bool Reaction::pushed() const noexcept {
    return sinceData_ < std::min(kPushTime, 0.5 * interval_);
}

double Reaction::rate(double appeared) noexcept {
    if (pushed()) {
        riseRate_ = std::clamp(appeared / (interval_ - sinceData_), riseRate_, kMaxRiseRate);
    }
    return sinceData_ < kFrameSlack * interval_ ? riseRate_ : kMaxRiseRate;
}

void Reaction::beginFade(const Wrench& wanted, const ReactionInput& input) noexcept {
    fade_.begin(sumOf(limitSize(lastFelt_, input.forceLimit, input.torqueLimit), wanted, -1.0),
                metricSize(wanted, k_), k_);
    noise_.settleAt(wanted); // what fades contains what was withheld
}

// A reaction that ended and begins in another direction begins at zero, and what is left of the former one
// fades for the rest of the frame.
bool Reaction::beginElsewhere(const Wrench& wanted, const ReactionInput& input) noexcept {
    const double size = metricSize(wanted, k_), left = interval_ - sinceData_;
    if (!ended_ || !(held_ > kMinFelt) || !(left > 0.0) || !(size > kMinFelt) ||
        metricProduct(lastFelt_, wanted, k_) > kSameDirection * size * lastFeltSize_) {
        return false;
    }
    fade_.begin(limitSize(lastFelt_, input.forceLimit, input.torqueLimit), 0.0, k_, left);
    noise_.settleAt(wanted);
    size_ = held_ = 0.0;
    return true;
}

// Begins to fade when new data took the reaction of a tool that lags, or of one of several regions. Ends when
// the reaction is back.
void Reaction::fadeLost(const Wrench& wanted, double byHand, const ReactionInput& input) noexcept {
    const double size = metricSize(wanted, k_), band = SurfaceNoise::kBand * input.springs.stiffness;
    if (fade_.active()) {
        if (size >= lastFeltSize_ &&
            metricProduct(wanted, fade_.lost(), k_) > kSameDirection * size * fade_.size()) {
            fade_.end();
            size_ = lastFeltSize_;
            noise_.settleAt(wanted);
        } else if (input.lags && pushed() && size < size_ - byHand - band) {
            beginFade(wanted, input);
        }
        return;
    }
    if (beginElsewhere(wanted, input)) {
        return;
    }
    const double along = metricProduct(lastFelt_, wanted, k_);
    const bool turned = size > kMinFelt && along > 0.0 && along <= kSameDirection * size * lastFeltSize_;
    const double lost = lastFeltSize_ - byHand - size;
    if (pushed() && ((input.lags && lost > band) || (turned && lost > std::min(band, kTurnedLoss)))) {
        beginFade(wanted, input);
    }
}

Wrench Reaction::withoutNoise(const Wrench& spring, double byHand, const ReactionInput& input) noexcept {
    SurfaceNoiseInput tick;
    tick.spring = spring;
    tick.byHand = byHand;
    tick.stiffness = input.springs.stiffness;
    tick.elapsed = elapsed_;
    tick.radius = k_;
    tick.dataPushes = pushed();
    return noise_.step(tick);
}

// What new data took of the reaction, beyond what the hand released, if the reaction keeps its direction or
// ends: else one region's force would be felt on another. It falls to zero until the next frame is due, and
// with the spring if the hand moves out. way: of the reaction, or of the last one that was felt if it ended.
// wanted [N]: size of the reaction. released [N]: by the hand, which moves out, in this tick. rendered: as in
// ReactionInput; what was not felt is not held back.
double Reaction::heldBack(const Wrench& way, double wanted, double byHand, double released,
                          double rendered) noexcept {
    const double left = interval_ - sinceData_, length = metricSize(way, k_);
    if (fade_.active() || !(left > 0.0) || !(length > kMinFelt)) {
        return held_ = 0.0;
    }
    const double before = metricProduct(lastFelt_, way, k_) / length;
    if (pushed() && before > kSameDirection * lastFeltSize_) {
        held_ = std::max(held_, std::min(before - byHand, rendered) - wanted);
    }
    ended_ = !(wanted > kMinFelt);
    const double had = wanted + kHeldShare * held_;
    const double kept = ended_ ? std::max(0.0, held_ - released) : held_ * had / (had + released);
    return held_ = kept * (1.0 - std::min(1.0, elapsed_ / left));
}

Wrench Reaction::limitRise(const Wrench& wrench, const Travel& travel, const ReactionInput& input) noexcept {
    const double wanted = metricSize(wrench, k_);
    // Out of the regions: along the wanted reaction, or the last one.
    const bool ended = !(wanted > kMinFelt) && lastFeltSize_ > kMinFelt;
    const Wrench way = ended ? lastFelt_ : wrench;
    const double length = ended ? lastFeltSize_ : wanted;
    const double out =
        length > 0.0 ? (glm::dot(travel.moved, way.force) + glm::dot(travel.turned, way.torque)) / length
                     : 0.0;
    const double compressed = out > 0.0 ? 0.0 : input.springs.stiffness * travel.length;
    const double calm = std::clamp(1.0 - out / (kLeavingSpeed * elapsed_), 0.0, 1.0);
    const double rises = std::min(rate(wanted - compressed - size_) * elapsed_, kMaxRiseRate * input.period);
    const double most = size_ + (input.mayRise ? compressed + calm * rises : 0.0);
    appears_ = wanted > size_ + compressed * (1.0 + 1e-9) + kRoundingForce;
    const double held = heldBack(way, wanted, input.springs.stiffness * travel.length,
                                 input.springs.stiffness * std::max(0.0, out), input.rendered);
    size_ = std::min(wanted + held, most);
    return size_ != wanted ? scaled(way, size_ / length) : wrench;
}

// New data that turns the reaction by more than a right angle begins a new one, from zero: the former
// direction would push the hand into what has appeared.
void Reaction::beginTurn(const Wrench& wrench, const ReactionInput& input) noexcept {
    if (!input.newData) {
        return;
    }
    const double size = metricSize(wrench, k_);
    turnLeft_ = 0.0;
    if (fade_.active() || !(lastFeltSize_ > kMinFelt) || !(size > kMinFelt)) {
        return;
    }
    if (metricProduct(lastFelt_, wrench, k_) < 0.0) {
        size_ = held_ = 0.0;
        return;
    }
    turnLeft_ = interval_;
    turnedForce_ = lastFeltSize_;
    turnBack_ = sumOf(scaled(lastFelt_, 1.0 / lastFeltSize_), scaled(wrench, 1.0 / size), -1.0);
}

// The change of direction that new data made at its adoption is taken back by a share that falls to zero, for
// as much of the reaction as there was before.
// What the hand turns meanwhile is felt at once: a lag of it would feed energy into a light hand.
Wrench Reaction::turning(const Wrench& wrench, const ReactionInput& input) noexcept {
    turnLeft_ = std::max(0.0, turnLeft_ - (input.newData ? input.period : elapsed_));
    const double share = turnLeft_ / interval_;
    if (!(share > 0.0) || !(size_ > kMinFelt)) {
        return wrench;
    }
    const Wrench mix = sumOf(wrench, turnBack_, share * std::min(size_, turnedForce_));
    const double length = metricSize(mix, k_);
    return length > kMinMixLength * size_ ? scaled(mix, size_ / length) : wrench;
}

Wrench Reaction::step(const ReactionInput& input) noexcept {
    k_ = std::max(1e-6, input.springs.metricRadius);
    keepTime(input);
    Wrench wrench = couple(input.springs, input.allowed, input.springEnd);
    const Travel travel = travelOf(input.springEnd);
    const double byHand = input.springs.stiffness * travel.length;
    if (input.vanished) {
        beginFade(wrench, input);
    } else {
        fadeLost(wrench, byHand, input);
    }
    wrench = withoutNoise(wrench, byHand, input);
    beginTurn(wrench, input);
    wrench = turning(limitRise(wrench, travel, input), input);
    if (fade_.active()) {
        const Wrench& lost = fade_.lost();
        const double out = glm::dot(travel.moved, lost.force) + glm::dot(travel.turned, lost.torque); // [N m]
        const double released =
            input.springs.stiffness * std::max(0.0, out) / std::max(kMinFelt, fade_.size());
        wrench = sumOf(wrench, fade_.step(wrench, released, k_, elapsed_));
    }
    lastFelt_ = wrench;
    lastFeltSize_ = metricSize(wrench, k_);
    return wrench;
}

} // namespace fathom
