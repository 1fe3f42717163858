// SPDX-License-Identifier: Apache-2.0
#include "engine/haptics/reaction.h"

#include "engine/haptics/limits.h"

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

// sqrt(|f|^2 + |tau / k|^2) [N]: the norm in which the spring wrench is K_t times the metric distance.
double sizeOf(const Wrench& wrench, double k) noexcept {
    const dvec3 turn = wrench.torque / k;
    return std::sqrt(glm::dot(wrench.force, wrench.force) + glm::dot(turn, turn));
}

Wrench sum(const Wrench& a, const Wrench& b, double share) noexcept {
    return {a.force + share * b.force, a.torque + share * b.torque};
}

// A part of the owed wrench, one tick later: at most `band` [N], which falls with kSettle, a small part with kCalm.
Wrench settled(const Wrench& owed, double band, double period, double k) noexcept {
    const double size = sizeOf(owed, k), full = size < band ? size / band : 1.0;
    const double share = std::exp(-period * (full / Reaction::kSettle + (1.0 - full) / Reaction::kCalm));
    return scaled(owed, size * share > band ? band / size : share);
}

} // namespace

// What new data changed in the spring, beyond what the hand's own motion can have changed, is owed to the
// hand and paid slowly. Along the reaction this delays its size, across it its direction.
Wrench Reaction::settling(const Wrench& raw, double travel, const ReactionInput& input) noexcept {
    const double k = std::max(1e-6, input.springs.metricRadius);
    const Wrench change = sum(raw, raw_, -1.0);
    const double size = sizeOf(change, k), byHand = input.springs.stiffness * travel;
    if (pushed() && size > byHand) {
        const double share = 1.0 - byHand / size;
        owed_ = sum(owed_, change, share);
    }
    raw_ = raw;
    const double now = sizeOf(raw, k), most = kOwedShare * now;
    const double band = std::min(kBand * input.springs.stiffness, most);
    const double product = glm::dot(owed_.force, raw.force) + glm::dot(owed_.torque, raw.torque) / (k * k);
    const Wrench along = scaled(raw, now > 0.0 ? product / (now * now) : 0.0);
    const Wrench across = sum(owed_, along, -1.0);
    owed_ = sum(settled(along, band, input.period, k),
                settled(across, std::max(band, kTurnBand * now), input.period, k), 1.0);
    owes_ = sizeOf(owed_, k) > kTurns;
    return sum(raw, owed_, -1.0);
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

void Reaction::vanish() noexcept {
    const double share = std::min(1.0, limit_ / std::max(1e-9, glm::length(last_.force)));
    faded_ = scaled(last_, share);
    fadedSize_ = share * felt_;
    left_ = kTail;
    replaced_ = 0.0;
}

// Begins the tail when new data took the reaction of a tool that lags, and ends it when the reaction is back.
void Reaction::keepWhileLagging(const Wrench& wanted, double travel, const ReactionInput& input) noexcept {
    const double k = std::max(1e-6, input.springs.metricRadius), size = sizeOf(wanted, k);
    const double byHand = input.springs.stiffness * travel, band = kBand * input.springs.stiffness;
    if (left_ > 0.0) {
        const double along =
            glm::dot(wanted.force, faded_.force) + glm::dot(wanted.torque, faded_.torque) / (k * k);
        if (size >= felt_ && along > kSameWay * size * fadedSize_) {
            size_ = felt_;
            left_ = 0.0;
            owed_ = {};
            raw_ = wanted;
        }
    } else if (input.lags && pushed() && size < felt_ - byHand - band) {
        vanish();
        owed_ = {}; // the tail contains it
        raw_ = wanted;
    }
}

// The fading rest of a reaction whose regions vanished. A new reaction takes its place for good: the tail
// must not come back when the new reaction ends.
Wrench Reaction::tail(double size, double period) noexcept {
    replaced_ = fadedSize_ > 0.0 ? std::max(replaced_, size / fadedSize_) : 1.0;
    left_ -= period;
    const double share = left_ / kTail - replaced_;
    left_ = share > 0.0 ? left_ : 0.0;
    return scaled(faded_, std::max(0.0, share));
}

// The change of direction that new data made at its adoption is taken back by a share that falls to zero.
// What the hand turns meanwhile is felt at once: a lag of it would feed energy into a light hand.
Wrench Reaction::turning(const Wrench& wrench, const ReactionInput& input) noexcept {
    const double k = std::max(1e-6, input.springs.metricRadius);
    const double size = sizeOf(wrench, k);
    if (input.newData) {
        turn_ = felt_ > kTurns && size > kTurns ? interval_ : 0.0;
        if (turn_ > 0.0) {
            const Wrench old = scaled(last_, 1.0 / felt_), now = scaled(wrench, 1.0 / size);
            from_ = sum(old, now, -1.0);
        }
    }
    turn_ = std::max(0.0, turn_ - input.period);
    const double share = turn_ / interval_;
    if (!(share > 0.0) || !(size > kTurns)) {
        return wrench;
    }
    const Wrench mix = sum(wrench, from_, share * size);
    const double length = sizeOf(mix, k);
    return length > kMinMix * size ? scaled(mix, size / length) : wrench;
}

Wrench Reaction::step(const ReactionInput& input) noexcept {
    const double k = std::max(1e-6, input.springs.metricRadius);
    Wrench wrench = couple(input.springs, input.allowed, input.end, dvec3(0.0), dvec3(0.0));
    since_ += input.period;
    limit_ = input.limit;
    if (input.newData) {
        interval_ = std::clamp(since_, input.period, kLongestFrame);
        since_ = 0.0;
        rate_ = kSlowest;
    }
    const Pose& before = started_ ? end_ : input.end;
    const dvec3 moved = input.end.position - before.position,
                turned = rotationLog(input.end.rotation * glm::conjugate(before.rotation));
    const double travel = std::sqrt(glm::dot(moved, moved) + glm::dot(k * turned, k * turned));
    keepWhileLagging(wrench, travel, input);
    wrench = settling(wrench, travel, input);
    const double wanted = sizeOf(wrench, k);
    // Along the wanted reaction, which is out of the regions.
    const double out =
        wanted > 0.0 ? (glm::dot(moved, wrench.force) + glm::dot(turned, wrench.torque)) / wanted : 0.0;
    const double compressed = out > 0.0 ? 0.0 : input.springs.stiffness * travel;
    const double calm = std::clamp(1.0 - out / (kLeaves * input.period), 0.0, 1.0);
    const double grows = compressed + calm * rate(wanted - compressed - size_) * input.period;
    const double most = size_ + (input.mayRise ? grows : 0.0);
    appears_ = wanted > size_ + compressed * (1.0 + 1e-9) + kRoundingForce;
    if (wanted > most) {
        wrench = scaled(wrench, most / wanted);
    }
    size_ = std::min(wanted, most);
    wrench = turning(wrench, input);
    end_ = input.end;
    started_ = true;
    if (left_ > 0.0) {
        wrench = sum(wrench, tail(size_, input.period), 1.0);
    }
    last_ = wrench;
    felt_ = sizeOf(wrench, k);
    return wrench;
}

} // namespace fathom
