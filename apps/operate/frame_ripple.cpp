// SPDX-License-Identifier: Apache-2.0
#include "apps/operate/frame_ripple.h"

#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

namespace fathom::operate {

namespace {

constexpr double kRippleSpan = 1.0; // [s]

} // namespace

void FrameRipple::add(double t, int64_t frame, const Wrench& delivered) {
    if (frame != frame_) {
        if (frame_ >= 0) {
            means_.push_back({last_, {sum_.force / ticks_, sum_.torque / ticks_}});
        }
        sum_ = {};
        ticks_ = 0.0;
        frame_ = frame;
    }
    sum_.force += delivered.force;
    sum_.torque += delivered.torque;
    ticks_ += 1.0;
    last_ = t;
    while (!means_.empty() && t - means_.front().t > kRippleSpan) {
        means_.pop_front();
    }
}

template <class Part>
double FrameRipple::rms(Part&& part) const {
    if (means_.size() < 3) {
        return std::numeric_limits<double>::quiet_NaN();
    }
    double sum = 0.0;
    for (size_t i = 1; i + 1 < means_.size(); ++i) {
        const dvec3 off =
            part(means_[i].wrench) - 0.5 * (part(means_[i - 1].wrench) + part(means_[i + 1].wrench));
        sum += glm::dot(off, off);
    }
    constexpr double kWeights = 1.5; // sum of the squares of 1, -1/2, -1/2
    return std::sqrt(sum / kWeights / static_cast<double>(means_.size() - 2));
}

double FrameRipple::force() const {
    return rms([](const Wrench& w) { return w.force; });
}

double FrameRipple::torque() const {
    return rms([](const Wrench& w) { return w.torque; });
}

} // namespace fathom::operate
