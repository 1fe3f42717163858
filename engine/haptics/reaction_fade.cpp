// SPDX-License-Identifier: Apache-2.0
#include "engine/haptics/reaction_fade.h"

#include "engine/haptics/limits.h"
#include "engine/haptics/wrench_metric.h"

#include <algorithm>

namespace fathom {

namespace {

constexpr double kNoForce = 1e-3;   // [N] a smaller reaction faces nothing
constexpr double kYieldTime = 0.02; // [s] time constant of the part that a reaction faces

} // namespace

void ReactionFade::begin(const Wrench& lost, double kept, double k, double time) noexcept {
    lost_ = lost;
    size_ = metricSize(lost, k);
    kept_ = kept;
    time_ = left_ = time;
    replaced_ = 0.0;
}

Wrench ReactionFade::step(const Wrench& reaction, double released, double k, double elapsed) noexcept {
    const double size = metricSize(reaction, k), product = metricProduct(lost_, reaction, k);
    if (product < 0.0 && size > kNoForce) {
        lost_ = sumOf(lost_, reaction, -std::min(1.0, elapsed / kYieldTime) * product / (size * size));
        size_ = metricSize(lost_, k);
    }
    if (!(size_ > kNoForce)) {
        left_ = 0.0;
        return {};
    }
    replaced_ = product < 0.0 ? replaced_ : std::max(replaced_, (size - kept_) / size_);
    left_ -= elapsed + time_ * released / size_;
    const double share = left_ / time_ - replaced_;
    left_ = share > 0.0 ? left_ : 0.0;
    return scaled(lost_, std::max(0.0, share));
}

} // namespace fathom
