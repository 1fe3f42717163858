// SPDX-License-Identifier: Apache-2.0
#include "engine/haptics/reaction.h"

#include "engine/haptics/limits.h"
#include "engine/haptics/wrench_metric.h"

#include <algorithm>
#include <cmath>

namespace fathom {

namespace {

constexpr double kSlowest = 10.0;       // [N/s] of a rise after new data
constexpr double kRoundingForce = 1e-6; // [N] rounding
constexpr double kTurns = 1e-3;         // [N] a smaller reaction has no direction that is felt
constexpr double kPushed = 0.012;       // [s] in which new data pushes a tool out, or half a frame
constexpr double kLate = 1.25;          // of a frame, until which the next one is waited for
constexpr double kMinMix = 0.3;         // directions that differ more than that are not mixed
constexpr double kSameWay = 0.8;        // cosine between the reaction that returns and the former one
constexpr double kOwedShare = 0.5;      // of the spring, so that force ends where contact ends
// Of the tool's motion round a ball, over the hand's: most, margin over what was seen, kept from tick to tick.
constexpr double kMaxGain = 8.0, kGainMargin = 1.2, kGainKept = 0.95;

// A part of the owed wrench, one tick later: at most `band` [N], which falls with kSettle, a small part with kCalm.
Wrench settled(const Wrench& owed, double band, double elapsed, double k) noexcept {
    const double size = metricSize(owed, k), full = size < band ? size / band : 1.0;
    const double share = std::exp(-elapsed * (full / Reaction::kSettle + (1.0 - full) / Reaction::kCalm));
    return scaled(owed, size * share > band ? band / size : share);
}

} // namespace

void Reaction::shift(const dvec3& by, const dquat& turn) noexcept {
    end_ = {end_.position + by, turn * end_.rotation};
}

void Reaction::keepTime(const ReactionInput& input) noexcept {
    elapsed_ = std::max(input.period, input.elapsed);
    since_ += elapsed_;
    if (input.newData) {
        interval_ = std::clamp(since_, input.period, kLongestFrame);
        since_ = 0.0;
        rate_ = kSlowest;
    }
}

Reaction::Travel Reaction::travelOf(const Pose& end) noexcept {
    const Pose before = started_ ? end_ : end;
    end_ = end;
    started_ = true;
    Travel travel{end.position - before.position, rotationLog(end.rotation * glm::conjugate(before.rotation)),
                  0.0};
    travel.length =
        std::sqrt(glm::dot(travel.moved, travel.moved) + glm::dot(k_ * travel.turned, k_ * travel.turned));
    return travel;
}

// The newest data may still be moving the tool.
bool Reaction::pushed() const noexcept {
    return since_ < std::min(kPushed, 0.5 * interval_);
}

double Reaction::rate(double appeared) noexcept {
    if (pushed()) {
        rate_ = std::clamp(appeared / (interval_ - since_), rate_, kAppear);
    }
    return since_ < kLate * interval_ ? rate_ : kAppear;
}

void Reaction::beginFade(const Wrench& wanted, const ReactionInput& input) noexcept {
    fade_.begin(sumOf(limitSize(last_, input.forceLimit, input.torqueLimit), wanted, -1.0),
                metricSize(wanted, k_), k_);
    owed_ = {}; // what fades contains it
    raw_ = wanted;
}

// Begins to fade when new data took the reaction of a tool that lags, and ends when the reaction is back.
void Reaction::keepWhileLagging(const Wrench& wanted, double byHand, const ReactionInput& input) noexcept {
    const double size = metricSize(wanted, k_), band = kBand * input.springs.stiffness;
    if (fade_.active()) {
        if (size >= felt_ && metricProduct(wanted, fade_.lost(), k_) > kSameWay * size * fade_.size()) {
            fade_.end();
            size_ = felt_;
            owed_ = {};
            raw_ = wanted;
        }
    } else if (input.lags && pushed() && size < felt_ - byHand - band) {
        beginFade(wanted, input);
    }
}

// What new data changed in the spring, beyond what the hand's own motion can have changed, is owed to the
// hand and paid slowly. Along the reaction this delays its size, across it its direction. Round a convex region
// the tool moves farther than the hand: by how much is seen while the regions rest.
Wrench Reaction::settling(const Wrench& raw, double byHand, const ReactionInput& input) noexcept {
    const Wrench change = sumOf(raw, raw_, -1.0);
    const double size = metricSize(change, k_);
    if (!pushed()) {
        const double seen = byHand > kRoundingForce ? kGainMargin * size / byHand : 1.0;
        gain_ = std::clamp(std::max(seen, kGainKept * gain_), 1.0, kMaxGain);
    } else if (size > gain_ * byHand) {
        owed_ = sumOf(owed_, change, 1.0 - gain_ * byHand / size);
    }
    raw_ = raw;
    const double now = metricSize(raw, k_), most = kOwedShare * now;
    const double band = std::min(kBand * input.springs.stiffness, most);
    const Wrench along = scaled(raw, now > 0.0 ? metricProduct(owed_, raw, k_) / (now * now) : 0.0);
    const Wrench across = sumOf(owed_, along, -1.0);
    owed_ = sumOf(settled(along, band, elapsed_, k_),
                  settled(across, std::max(band, kTurnBand * now), elapsed_, k_));
    owes_ = metricSize(owed_, k_) > kTurns;
    return sumOf(raw, owed_, -1.0);
}

Wrench Reaction::limitRise(const Wrench& wrench, const Travel& travel, const ReactionInput& input) noexcept {
    const double wanted = metricSize(wrench, k_);
    // Along the wanted reaction, which is out of the regions.
    const double out =
        wanted > 0.0
            ? (glm::dot(travel.moved, wrench.force) + glm::dot(travel.turned, wrench.torque)) / wanted
            : 0.0;
    const double compressed = out > 0.0 ? 0.0 : input.springs.stiffness * travel.length;
    const double calm = std::clamp(1.0 - out / (kLeaves * elapsed_), 0.0, 1.0);
    const double rises = std::min(rate(wanted - compressed - size_) * elapsed_, kAppear * input.period);
    const double most = size_ + (input.mayRise ? compressed + calm * rises : 0.0);
    appears_ = wanted > size_ + compressed * (1.0 + 1e-9) + kRoundingForce;
    size_ = std::min(wanted, most);
    return wanted > most ? scaled(wrench, most / wanted) : wrench;
}

// New data that turns the reaction by more than a right angle begins a new one, from zero: the former direction
// would push the hand into what has appeared.
void Reaction::beginTurn(const Wrench& wrench, const ReactionInput& input) noexcept {
    if (!input.newData) {
        return;
    }
    const double size = metricSize(wrench, k_);
    turn_ = 0.0;
    if (fade_.active() || !(felt_ > kTurns) || !(size > kTurns)) {
        return;
    }
    if (metricProduct(last_, wrench, k_) < 0.0) {
        size_ = 0.0;
        return;
    }
    turn_ = interval_;
    turned_ = felt_;
    from_ = sumOf(scaled(last_, 1.0 / felt_), scaled(wrench, 1.0 / size), -1.0);
}

// The change of direction that new data made at its adoption is taken back by a share that falls to zero, for
// as much of the reaction as there was before.
// What the hand turns meanwhile is felt at once: a lag of it would feed energy into a light hand.
Wrench Reaction::turning(const Wrench& wrench, const ReactionInput& input) noexcept {
    turn_ = std::max(0.0, turn_ - (input.newData ? input.period : elapsed_));
    const double share = turn_ / interval_;
    if (!(share > 0.0) || !(size_ > kTurns)) {
        return wrench;
    }
    const Wrench mix = sumOf(wrench, from_, share * std::min(size_, turned_));
    const double length = metricSize(mix, k_);
    return length > kMinMix * size_ ? scaled(mix, size_ / length) : wrench;
}

Wrench Reaction::step(const ReactionInput& input) noexcept {
    k_ = std::max(1e-6, input.springs.metricRadius);
    keepTime(input);
    Wrench wrench = couple(input.springs, input.allowed, input.end, dvec3(0.0), dvec3(0.0));
    const Travel travel = travelOf(input.end);
    const double byHand = input.springs.stiffness * travel.length;
    if (input.vanished) {
        beginFade(wrench, input);
    } else {
        keepWhileLagging(wrench, byHand, input);
    }
    wrench = settling(wrench, byHand, input);
    beginTurn(wrench, input);
    wrench = turning(limitRise(wrench, travel, input), input);
    if (fade_.active()) {
        const Wrench& lost = fade_.lost();
        const double out = glm::dot(travel.moved, lost.force) + glm::dot(travel.turned, lost.torque); // [N m]
        const double released = input.springs.stiffness * std::max(0.0, out) / std::max(kTurns, fade_.size());
        wrench = sumOf(wrench, fade_.step(wrench, released, k_, elapsed_));
    }
    last_ = wrench;
    felt_ = metricSize(wrench, k_);
    return wrench;
}

} // namespace fathom
