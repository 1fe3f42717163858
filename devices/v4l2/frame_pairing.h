// SPDX-License-Identifier: Apache-2.0
// Which colour picture goes with which depth picture of two streams that are not synchronous: by time stamp.
#pragma once

#include "devices/v4l2/capture_stream.h"

#include <deque>
#include <optional>
#include <utility>
#include <vector>

namespace fathom {

// One thread. Holds what it is given until it lets it go by next() or released(); knows nothing of buffers
// but their stamps.
//
// A depth picture takes the colour picture nearest in time. A colour within 0.55 of the colour's period is
// taken at once (none nearer can come but by jitter); otherwise it waits until a later colour or a third
// depth picture settles it; nothing within a whole period: the depth picture is let go unpaired. A colour
// picture serves every depth picture that it is nearest to.
class FramePairing {
public:
    // A depth picture and the colour picture nearest to it in time, where one is near enough.
    struct Pair {
        CapturedBuffer depth;
        std::optional<CapturedBuffer> colour;
    };

    // colourPeriod [s]: 0 = there is no colour, each depth picture is a pair.
    explicit FramePairing(double colourPeriod);

    // The next buffer of that stream, in order.
    void depth(const CapturedBuffer& buffer);
    void colour(const CapturedBuffer& buffer);

    // The next depth picture, in order, that is settled. Its colour stays with the pairing: use it before the
    // next call of anything here.
    std::optional<Pair> next();
    // Buffers that are no longer needed and in no pair, since the last call: depth unpaired, colour used up.
    std::vector<CapturedBuffer> unpairedDepth() { return std::exchange(unpaired_, {}); }
    std::vector<CapturedBuffer> usedColour() { return std::exchange(used_, {}); }
    // Everything held is let go, as unpaired and used up.
    void letGo();
    // Everything held is forgotten (the streams start anew).
    void clear();

private:
    const CapturedBuffer* nearest(double stamp) const;
    void dropColourBefore(double stamp);

    double period_;
    std::deque<CapturedBuffer> depth_, colour_; // oldest first
    std::vector<CapturedBuffer> unpaired_, used_;
};

} // namespace fathom
