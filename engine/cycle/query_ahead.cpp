// SPDX-License-Identifier: Apache-2.0
#include "engine/cycle/query_ahead.h"

#include <algorithm>
#include <cmath>

namespace fathom {

namespace {

constexpr double kForgetAge = 1.0; // [s] time constant with which the effect of a late answer decays
constexpr double kShortest = 1e-6; // [s] between ticks

} // namespace

void QueryAhead::moved(const ToolPlace& now, double elapsed) noexcept {
    // A late tick covers a longer motion, and the next one a shorter one.
    const double seconds = elapsed > 0.0 ? std::max(elapsed, kShortest) : period_;
    const double blend = started_ ? std::min(1.0, seconds / kSmooth) : 0.0;
    const dvec3 turned = rotationBetween(before_.pose.rotation, now.pose.rotation);
    velocity_ = started_ ? velocity_ : dvec3(0.0);
    spin_ = started_ ? spin_ : dvec3(0.0);
    velocity_ += blend * ((now.pose.position - before_.pose.position) / seconds - velocity_);
    spin_ += blend * (turned / seconds - spin_);
    for (size_t k = 0; k < rates_.size(); ++k) {
        const double rate = started_ ? (now.arm.q[k] - before_.arm.q[k]) / seconds : 0.0;
        rates_[k] = started_ ? rates_[k] + blend * (rate - rates_[k]) : 0.0;
    }
    before_ = now;
    started_ = true;
}

void QueryAhead::answered(double askedAt, double now) noexcept {
    if (!std::isfinite(now - askedAt)) { // asked before the first step
        return;
    }
    // In whole ticks, so that the rounding of a clock changes nothing.
    const double age = period_ * std::round(std::clamp(now - askedAt, 0.0, kMaxLead) / period_);
    age_ = std::max(age, age_ - period_ * std::min(1.0, age_ / kForgetAge));
}

double QueryAhead::lead() const noexcept {
    return age_ > kInTime * period_ ? age_ : 0.0;
}

QueryPlace QueryAhead::ask(const ToolPlace& now, double time, size_t joints) const noexcept {
    QueryPlace ahead{now, time};
    const double lead = this->lead();
    if (lead == 0.0) {
        return ahead;
    }
    ahead.place.pose.position += lead * velocity_;
    ahead.place.pose.rotation = glm::normalize(rotationExp(lead * spin_) * now.pose.rotation);
    for (size_t k = 0; k < joints; ++k) {
        ahead.place.arm.q[k] += lead * rates_[k];
    }
    const double unsure = 0.25 * glm::length(velocity_) * lead + 0.5 * kHandAccel * lead * lead;
    ahead.extraReach = std::min(kMaxReach, unsure);
    return ahead;
}

} // namespace fathom
