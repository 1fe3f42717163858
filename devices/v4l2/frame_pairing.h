// SPDX-License-Identifier: Apache-2.0
// Pairs colour and depth frames of two unsynchronised streams by time stamp.
#pragma once

#include "devices/v4l2/capture_stream.h"

#include <deque>
#include <optional>
#include <utility>
#include <vector>

namespace fathom {

// One thread. Keeps each buffer until next() or released() returns it; uses only the stamps.
//
// A depth frame is paired with the colour frame nearest in time. A colour frame within 0.55 of the colour
// period is taken at once (only jitter could bring a nearer one); otherwise the depth frame waits for a later
// colour frame or a third depth frame. With none within a whole period, the depth frame is released unpaired.
// A colour frame pairs with every depth frame that it is nearest to.
class FramePairing {
public:
    // A depth frame and the nearest colour frame, if close enough.
    struct Pair {
        CapturedBuffer depth;
        std::optional<CapturedBuffer> colour;
    };

    // colourPeriod [s]: 0 = no colour, each depth frame is a pair.
    explicit FramePairing(double colourPeriod);

    // The next buffer of that stream, in order.
    void depth(const CapturedBuffer& buffer);
    void colour(const CapturedBuffer& buffer);

    // The next settled depth frame, in order. Its colour stays owned by the pairing: use it before the next
    // call.
    std::optional<Pair> next();
    // Buffers released since the last call: unpaired depth and used colour.
    std::vector<CapturedBuffer> unpairedDepth() { return std::exchange(unpaired_, {}); }
    std::vector<CapturedBuffer> usedColour() { return std::exchange(used_, {}); }
    // Releases everything as unpaired and used.
    void letGo();
    // Forgets everything (the streams restart).
    void clear();

private:
    void dropColourBefore(double stamp);

    double period_;
    std::deque<CapturedBuffer> depth_, colour_; // oldest first
    std::vector<CapturedBuffer> unpaired_, used_;
};

} // namespace fathom
