// SPDX-License-Identifier: Apache-2.0
#include "devices/v4l2/frame_pairing.h"

#include "devices/nearest_stamp.h"

#include <cmath>

namespace fathom {

namespace {

constexpr double kAtOnce = 0.55, kAtMost = 1.0; // of the colour's period
constexpr size_t kWaiting = 2;                  // depth frames that may wait, of four buffers
constexpr size_t kColours = 2;                  // kept colour frames; the driver needs the other buffers

} // namespace

FramePairing::FramePairing(double colourPeriod)
    : period_(colourPeriod) {}

void FramePairing::depth(const CapturedBuffer& buffer) {
    depth_.push_back(buffer);
}

void FramePairing::colour(const CapturedBuffer& buffer) {
    colour_.push_back(buffer);
    while (colour_.size() > kColours) {
        used_.push_back(colour_.front());
        colour_.pop_front();
    }
}

void FramePairing::letGo() {
    unpaired_.insert(unpaired_.end(), depth_.begin(), depth_.end());
    used_.insert(used_.end(), colour_.begin(), colour_.end());
    depth_.clear();
    colour_.clear();
}

void FramePairing::clear() {
    depth_.clear();
    colour_.clear();
    unpaired_.clear();
    used_.clear();
}

// The newest one at or before `stamp` may still be the nearest to the next depth frame.
void FramePairing::dropColourBefore(double stamp) {
    while (colour_.size() > 1 && colour_[1].stamp <= stamp) {
        used_.push_back(colour_.front());
        colour_.pop_front();
    }
}

std::optional<FramePairing::Pair> FramePairing::next() {
    while (!depth_.empty()) {
        const CapturedBuffer oldest = depth_.front();
        if (period_ == 0.0) {
            depth_.pop_front();
            return Pair{oldest, std::nullopt};
        }
        dropColourBefore(oldest.stamp);
        const CapturedBuffer* best = nearestStamp(colour_, oldest.stamp);
        const double distance = best == nullptr ? INFINITY : std::abs(best->stamp - oldest.stamp);
        const bool later = !colour_.empty() && colour_.back().stamp >= oldest.stamp;
        if (distance > kAtOnce * period_ && !later && depth_.size() <= kWaiting) {
            return std::nullopt;
        }
        depth_.pop_front();
        if (distance <= kAtMost * period_) {
            return Pair{oldest, *best};
        }
        unpaired_.push_back(oldest);
    }
    return std::nullopt;
}

} // namespace fathom
