// SPDX-License-Identifier: Apache-2.0
// Pairs the depth and colour images of two live topics by their stamps.
#pragma once

#include "devices/ros2/raw_message.h"

#include <cstddef>
#include <deque>
#include <optional>
#include <utility>

namespace fathom {

// An image, not yet decoded.
struct LiveImage {
    double stamp = 0.0; // [s] of its header
    RawMessagePtr message;
};

// A depth image gets the colour image with the nearest stamp, at most half the slower topic's period away.
// It waits for one that may be nearer for at most kPatience. Without colour every depth image is ready at
// once. One thread.
class LivePairs {
public:
    struct Pair { // colour: empty without a topic of it
        LiveImage depth;
        std::optional<LiveImage> colour;
    };
    explicit LivePairs(bool hasColour)
        : hasColour_(hasColour) {}

    void depth(LiveImage image);
    void colour(LiveImage image);
    // The oldest pair that is ready; now [s] CLOCK_MONOTONIC.
    std::optional<Pair> next(double now);
    // Depth images that were given up since the last call: those without colour, and those that were too
    // many.
    size_t takeUnpaired() { return std::exchange(unpaired_, 0); }
    // Seconds until a depth image that is here no longer waits; at most `longest`.
    double patience(double now, double longest) const;
    void clear();
    double within() const; // [s] largest difference of a pair's stamps

    static constexpr double kPatience = 0.15; // [s]

private:
    struct Period {
        double last = 0.0, seconds = 1.0 / 30.0;
        void add(double stamp);
    };
    const LiveImage* nearest(double stamp) const;

    static constexpr size_t kMax = 16;

    bool hasColour_;
    std::deque<LiveImage> depth_, colour_;
    Period depthPeriod_, colourPeriod_;
    size_t unpaired_ = 0;
};

} // namespace fathom
