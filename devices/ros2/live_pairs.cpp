// SPDX-License-Identifier: Apache-2.0
#include "devices/ros2/live_pairs.h"

#include "devices/nearest_stamp.h"

#include <algorithm>
#include <cmath>

namespace fathom {

void LivePairs::Period::add(double stamp) {
    constexpr double kShare = 0.2, kShortest = 0.002, kLongest = 0.5; // [s]
    const double since = stamp - last;
    if (last > 0.0 && since >= kShortest && since <= kLongest) { // else a jump, or a loss
        seconds += kShare * (since - seconds);
    }
    last = stamp;
}

void LivePairs::depth(LiveImage image) {
    depthPeriod_.add(image.stamp);
    depth_.push_back(std::move(image));
    if (depth_.size() > kMax) {
        depth_.pop_front();
        ++unpaired_;
    }
}

void LivePairs::colour(LiveImage image) {
    colourPeriod_.add(image.stamp);
    if (!colour_.empty() && image.stamp < colour_.back().stamp) { // its clock was set back
        colour_.clear();
    }
    colour_.push_back(std::move(image));
    if (colour_.size() > kMax) {
        colour_.pop_front();
    }
}

double LivePairs::within() const {
    return 0.5 * std::max(depthPeriod_.seconds, colourPeriod_.seconds);
}

const LiveImage* LivePairs::nearest(double stamp) const {
    const LiveImage* best = nearestStamp(colour_, stamp);
    return best != nullptr && std::abs(best->stamp - stamp) <= within() ? best : nullptr;
}

std::optional<LivePairs::Pair> LivePairs::next(double now) {
    while (!depth_.empty()) {
        const LiveImage& first = depth_.front();
        const bool settled = !hasColour_ || (!colour_.empty() && colour_.back().stamp >= first.stamp) ||
                             now >= first.message->arrival + kPatience;
        if (!settled) {
            return std::nullopt;
        }
        const LiveImage* colour = hasColour_ ? nearest(first.stamp) : nullptr;
        Pair pair{first, colour != nullptr ? std::optional(*colour) : std::nullopt};
        depth_.pop_front();
        if (!hasColour_ || colour != nullptr) {
            return pair;
        }
        ++unpaired_;
    }
    return std::nullopt;
}

double LivePairs::patience(double now, double longest) const {
    return depth_.empty() ? longest
                          : std::clamp(depth_.front().message->arrival + kPatience - now, 0.0, longest);
}

void LivePairs::clear() {
    depth_.clear();
    colour_.clear();
}

} // namespace fathom
