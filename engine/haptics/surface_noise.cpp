// SPDX-License-Identifier: Apache-2.0
#include "engine/haptics/surface_noise.h"

#include "engine/haptics/limits.h"
#include "engine/haptics/wrench_metric.h"

#include <algorithm>
#include <cmath>

namespace fathom {

namespace {

constexpr double kRoundingWork = 1e-6; // [N] rounding
constexpr double kFeltAtAll = 1e-3;    // [N] less is not felt
constexpr double kOwedShare = 0.5;     // of the spring
constexpr double kNoise = 0.5;         // of the mean over the mean size: up to here it is noise
constexpr double kForgets = 10.0;      // [s/s] without contact, of the time constant
constexpr double kElsewhere = 0.01;    // [m] of travel, after which the surface is another one,
constexpr double kCalmElsewhere = 1.2; // [s] and the time constant at most there
// Of the tool's motion round a ball, over the hand's: most, margin over what was seen, kept from tick to tick.
constexpr double kMaxGain = 8.0, kGainMargin = 1.2, kGainKept = 0.95;

} // namespace

void SurfaceNoise::settleAt(const Wrench& spring) noexcept {
    owed_ = {};
    spring_ = spring;
}

// Round a convex region the tool moves farther than the hand: by how much is seen while the regions rest.
void SurfaceNoise::owe(const SurfaceNoiseInput& input) noexcept {
    const Wrench change = sumOf(input.spring, spring_, -1.0);
    const double size = metricSize(change, input.radius);
    if (!input.dataPushes) {
        const double seen = input.byHand > kRoundingWork ? kGainMargin * size / input.byHand : 1.0;
        gain_ = std::clamp(std::max(seen, kGainKept * gain_), 1.0, kMaxGain);
    } else if (size > gain_ * input.byHand) {
        owed_ = sumOf(owed_, change, 1.0 - gain_ * input.byHand / size);
    }
    spring_ = input.spring;
}

// The time constant, which a hand at rest lets grow, and one that moves on or leaves does not.
void SurfaceNoise::grow(const SurfaceNoiseInput& input, bool contact) noexcept {
    if (!contact) {
        calm_ = std::max(kSettle, calm_ - kForgets * input.elapsed);
        return;
    }
    calm_ = std::min(kCalmest, calm_ + input.elapsed);
    const double travel = input.stiffness > 0.0 ? input.byHand / input.stiffness : 0.0;
    calm_ = std::max(std::min(calm_, kCalmElsewhere), calm_ * (1.0 - travel / kElsewhere));
}

// What is still owed after this tick.
Wrench SurfaceNoise::paid(const Part& part, double elapsed, double radius) noexcept {
    const double size = metricSize(part.owed, radius);
    const double sameWay = metricSize(part.mean, radius) / std::max(part.meanSize, kFeltAtAll);
    const double stays = std::clamp((sameWay - kNoise) / (1.0 - kNoise), 0.0, 1.0);
    const double share = std::exp(-elapsed * (stays / kSettle + (1.0 - stays) / part.timeSlow));
    return scaled(part.owed, size * share > part.mostOwed ? part.mostOwed / size : share);
}

Wrench SurfaceNoise::step(const SurfaceNoiseInput& input) noexcept {
    owe(input);
    const double k = input.radius, now = metricSize(input.spring, k);
    grow(input, now > 0.0);
    const auto alongSpring = [&](const Wrench& w) {
        return scaled(input.spring, now > 0.0 ? metricProduct(w, input.spring, k) / (now * now) : 0.0);
    };
    const double share = 1.0 - std::exp(-input.elapsed / kWatch);
    meanOwed_ = sumOf(meanOwed_, sumOf(owed_, meanOwed_, -1.0), share);
    Part along, across;
    along.owed = alongSpring(owed_);
    along.mean = alongSpring(meanOwed_);
    across.owed = sumOf(owed_, along.owed, -1.0);
    across.mean = sumOf(meanOwed_, along.mean, -1.0);
    meanAlong_ += share * (metricSize(along.owed, k) - meanAlong_);
    meanAcross_ += share * (metricSize(across.owed, k) - meanAcross_);
    along.meanSize = meanAlong_;
    across.meanSize = meanAcross_;
    along.mostOwed = std::min(kBand * input.stiffness, kOwedShare * now);
    across.mostOwed = std::max(along.mostOwed, kTurnBand * now);
    along.timeSlow = across.timeSlow = calm_;
    owed_ = sumOf(paid(along, input.elapsed, k), paid(across, input.elapsed, k));
    owes_ = metricSize(owed_, k) > kFeltAtAll;
    return sumOf(input.spring, owed_, -1.0);
}

} // namespace fathom
