// SPDX-License-Identifier: Apache-2.0
#include "engine/haptics/stiffness_watch.h"

#include <algorithm>
#include <cmath>

namespace fathom {

StiffnessWatch::StiffnessWatch(const DevicePreset& preset, const CouplingOptions& options,
                               const Springs& planned)
    : options_(options)
    , planned_(planned)
    , springs_(planned)
    , period_(options.period) {
    // With hand map scale s the hand feels s K_t and K_r / s (hand_map.h), and B likewise.
    if (preset.damping && !options.stiffness) {
        damping_ = *preset.damping / options.handScale;
    }
    if (preset.rotationalDamping && !options.rotationalStiffness) {
        rotationalDamping_ = *preset.rotationalDamping * options.handScale;
    }
}

double StiffnessWatch::wantedShare() const noexcept {
    if (!damping_) {
        return 1.0;
    }
    const double whole = planned_.stiffness + planned_.guidanceStiffness;
    const double bound =
        options_.margin * passiveStiffness(*damping_, options_.damping, period_, options_.delayTicks);
    return std::clamp(bound / whole, kMinShare, 1.0);
}

void StiffnessWatch::step(double measuredPeriod) noexcept {
    if (!(measuredPeriod > 0.0) || !std::isfinite(measuredPeriod)) {
        return;
    }
    const double counts = std::min(measuredPeriod, std::max(kLateAlone, before_));
    before_ = std::max(measuredPeriod, kForget * before_);
    period_ += std::min(1.0, counts / kAverage) * (counts - period_);
    share_ += std::clamp(wantedShare() - share_, -counts / kDown, counts / kUp);
    springs_ = planned_;
    springs_.stiffness = share_ * planned_.stiffness;
    springs_.guidanceStiffness = share_ * planned_.guidanceStiffness;
    double turn = planned_.rotationalStiffness;
    if (!options_.rotationalStiffness) {
        // The smallest of the planned K_r, k0^2 K_t and the rotational bound. All change slowly.
        turn = std::min(turn, options_.toolRadius * options_.toolRadius * springs_.stiffness);
        if (rotationalDamping_) {
            const double bound =
                options_.margin * passiveStiffness(*rotationalDamping_, options_.rotationalDamping, period_,
                                                   options_.delayTicks);
            turn = std::min(turn, std::max(bound, kMinShare * planned_.rotationalStiffness));
        }
    }
    springs_.setRotational(turn);
}

} // namespace fathom
