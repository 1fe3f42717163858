// SPDX-License-Identifier: Apache-2.0
#include "engine/haptics/force_ramps.h"

#include <algorithm>

namespace fathom {

void ForceRamps::step(const std::array<bool, kReasons>& on, double period, double elapsed, double rendered,
                      double riseTime) noexcept {
    bool all = true;
    for (size_t reason = 0; reason < kReasons; ++reason) {
        const double time = reason == Stale ? kFadeTime : kRampTime;
        double& gain = gain_[reason];
        if (!on[reason]) {
            gain = std::max(0.0, gain - elapsed / time);
            all = false;
        } else if (gain < 1.0) { // forces return for this reason
            rise_ = std::max(limitScale_ < 1.0 ? rise_ : 0.0, reason == SwitchedOff ? riseTime : time);
            limitScale_ = std::min(limitScale_, rendered);
            gain = 1.0;
        }
    }
    if (fadeGain() == 0.0) {
        limitScale_ = 0.0;
    }
    if (all) {
        limitScale_ = std::min(1.0, limitScale_ + period / rise_);
    }
}

void ForceRamps::cut() noexcept {
    gain_[SwitchedOff] = 0.0;
    limitScale_ = 0.0;
}

} // namespace fathom
