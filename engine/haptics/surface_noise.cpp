// SPDX-License-Identifier: Apache-2.0
#include "engine/haptics/surface_noise.h"

#include "engine/haptics/limits.h"
#include "engine/haptics/wrench_metric.h"

#include <algorithm>
#include <cmath>

namespace fathom {

namespace {

constexpr double kMinByHand = 1e-6;        // [N] less is rounding
constexpr double kWithheldShare = 0.5;     // of the spring
constexpr double kNoiseRatio = 0.65;       // of the mean over the mean size: up to here it is noise
constexpr double kSlowTimeDecay = 10.0;    // [s/s] without contact, of the time constant
constexpr double kNewPlaceTravel = 0.002;  // [m] of travel, in which a shift of the tool is undone by sliding
constexpr double kNewSurfaceTravel = 0.01; // [m] of travel, after which the surface is another one,
constexpr double kNewSurfaceSlowTime = 1.2; // [s] and the time constant at most there
// Of the tool's motion round a ball, over the hand's: most, margin over what was seen, kept from tick to
// tick.
constexpr double kMaxGain = 8.0, kGainMargin = 1.2, kGainKept = 0.95;

double travelOf(const SurfaceNoiseInput& input) { // [m] of the hand
    return input.stiffness > 0.0 ? input.byHand / input.stiffness : 0.0;
}

} // namespace

void SurfaceNoise::settleAt(const Wrench& spring) noexcept {
    withheld_ = {};
    spring_ = spring;
}

// Round a convex region the tool moves farther than the hand: by how much is seen while the regions rest.
void SurfaceNoise::withhold(const SurfaceNoiseInput& input) noexcept {
    const Wrench change = sumOf(input.spring, spring_, -1.0);
    const double size = metricSize(change, input.radius);
    if (!input.dataPushes) {
        const double seen = input.byHand > kMinByHand ? kGainMargin * size / input.byHand : 1.0;
        gain_ = std::clamp(std::max(seen, kGainKept * gain_), 1.0, kMaxGain);
    } else if (size > gain_ * input.byHand) {
        withheld_ = sumOf(withheld_, change, 1.0 - gain_ * input.byHand / size);
    }
    spring_ = input.spring;
}

// The time constant grows while the hand rests, and shrinks while it moves on or has left.
void SurfaceNoise::adaptSlowTime(const SurfaceNoiseInput& input, bool contact) noexcept {
    if (!contact) {
        slowTime_ = std::max(kSettle, slowTime_ - kSlowTimeDecay * input.elapsed);
        return;
    }
    slowTime_ = std::min(kMaxSlowTime, slowTime_ + input.elapsed);
    slowTime_ = std::max(std::min(slowTime_, kNewSurfaceSlowTime),
                         slowTime_ * (1.0 - travelOf(input) / kNewSurfaceTravel));
}

// After this tick.
Wrench SurfaceNoise::stillWithheld(const Part& part, double elapsed, double radius) noexcept {
    const double size = metricSize(part.withheld, radius);
    const double sameWay = metricSize(part.mean, radius) / std::max(part.meanSize, kMinFelt);
    const double stays = std::clamp((sameWay - kNoiseRatio) / (1.0 - kNoiseRatio), 0.0, 1.0);
    const double decay = std::exp(-elapsed * (stays / kSettle + (1.0 - stays) / part.slowTime));
    return scaled(part.withheld, size * decay > part.most ? part.most / size : decay);
}

Wrench SurfaceNoise::step(const SurfaceNoiseInput& input) noexcept {
    withhold(input);
    const double k = input.radius, now = metricSize(input.spring, k);
    adaptSlowTime(input, now > 0.0);
    const auto alongSpring = [&](const Wrench& w) {
        return scaled(input.spring, now > 0.0 ? metricProduct(w, input.spring, k) / (now * now) : 0.0);
    };
    const double blend = 1.0 - std::exp(-input.elapsed / kWatch);
    meanWithheld_ = sumOf(meanWithheld_, sumOf(withheld_, meanWithheld_, -1.0), blend);
    Part along, across;
    along.withheld = alongSpring(withheld_);
    along.mean = alongSpring(meanWithheld_);
    across.withheld =
        scaled(sumOf(withheld_, along.withheld, -1.0), std::exp(-travelOf(input) / kNewPlaceTravel));
    across.mean = sumOf(meanWithheld_, along.mean, -1.0);
    meanAlong_ += blend * (metricSize(along.withheld, k) - meanAlong_);
    meanAcross_ += blend * (metricSize(across.withheld, k) - meanAcross_);
    along.meanSize = meanAlong_;
    across.meanSize = meanAcross_;
    along.most = std::min(kBand * input.stiffness, kWithheldShare * now);
    across.most = std::max(along.most, kTurnBand * now);
    along.slowTime = across.slowTime = slowTime_;
    withheld_ = sumOf(stillWithheld(along, input.elapsed, k), stillWithheld(across, input.elapsed, k));
    withholds_ = metricSize(withheld_, k) > kMinFelt;
    return sumOf(input.spring, withheld_, -1.0);
}

} // namespace fathom
