// SPDX-License-Identifier: Apache-2.0
// What is left of a reaction whose regions are gone: it fades out.
#pragma once

#include "engine/types/wrench.h"

namespace fathom {

// One thread; noexcept, no allocation. Wrenches are measured as in wrench_metric.h, with radius k [m].
class ReactionFade {
public:
    static constexpr double kTime = 0.2; // [s]

    // Begins, or begins anew. lost: on the hand, without what the regions that remain still give, which
    // is `kept` [N]. time [s]: until it is zero.
    void begin(const Wrench& lost, double kept, double k, double time = kTime) noexcept;
    void end() noexcept { left_ = 0.0; }

    // The rest in this tick. A reaction that grows beyond `kept` takes the place of as much of it for good,
    // and the part that faces a reaction yields to it within some 20 ms. released [N]: by which a spring of
    // this direction would have fallen, because the hand moved out. elapsed [s] since the tick before.
    Wrench step(const Wrench& reaction, double released, double k, double elapsed) noexcept;

    bool active() const noexcept { return left_ > 0.0; }
    const Wrench& lost() const noexcept { return lost_; }
    double size() const noexcept { return size_; } // [N] of lost()

private:
    Wrench lost_;
    double size_ = 0.0, kept_ = 0.0;   // [N]
    double time_ = kTime, left_ = 0.0; // [s]
    double replaced_ = 0.0;            // share of it whose place was taken
};

} // namespace fathom
