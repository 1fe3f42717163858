// SPDX-License-Identifier: Apache-2.0
// How much the wrench changes from frame to frame: what noise of the camera does to a still hand.
#pragma once

#include "engine/types/wrench.h"

#include <cstdint>
#include <deque>

namespace fathom::operate {

// Window thread. A mean is taken over the ticks that use one fixture set; the ripple is the RMS, over the
// last second, of the difference between a mean and the line through its neighbours. So a slow motion of the
// hand does not count, and independent errors of frames with an RMS of s give s.
class FrameRipple {
public:
    // t [s] ascending; frame: whose set the tick uses, below 0 = none.
    void add(double t, int64_t frame, const Wrench& delivered);

    double force() const;  // [N]; NaN before the third frame
    double torque() const; // [N m], same

private:
    template <class Part>
    double rms(Part&& part) const;

    struct Mean {
        double t = 0.0; // [s] of its last tick
        Wrench wrench;
    };
    std::deque<Mean> means_; // of complete frames, oldest first
    Wrench sum_;
    double ticks_ = 0.0, last_ = 0.0;
    int64_t frame_ = -1;
};

} // namespace fathom::operate
