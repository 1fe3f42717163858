// SPDX-License-Identifier: Apache-2.0
// Keeps the noise of a sensor out of the reaction: what new data changes in the spring is felt slowly, what the
// hand changes at once.
#pragma once

#include "engine/types/wrench.h"

namespace fathom {

// Input of one tick.
struct SurfaceNoiseInput {
    Wrench spring;           // between the hand and the pose that the rows allow
    double byHand = 0.0;     // [N] of change that the hand's own travel can cause
    double stiffness = 0.0;  // [N/m]
    double elapsed = 0.001;  // [s] since the last tick
    double radius = 1.0;     // k [m], as in wrench_metric.h
    bool dataPushes = false; // new data may be moving the tool
};

// One thread; noexcept, no allocation. What new data changed is owed to the hand and paid slowly: along the
// reaction at most kBand of its size, across it kBand, or kTurnBand of the reaction if that is more. Never more
// than half of the reaction, so that force ends where contact ends.
//
// How slowly depends on whether the change stays. The mean of what is owed, over kWatch, is near zero while noise
// makes it change its sign, and near its size when a surface has moved. What stays is paid with the time constant
// kSettle. The rest is paid with one that grows by a second per second while the hand rests on the surface, up to
// kCalmest: so the felt surface is the mean of all surfaces since the contact began.
class SurfaceNoise {
public:
    static constexpr double kBand = 0.002;   // [m] of motion of the surface
    static constexpr double kTurnBand = 0.2; // share of the reaction: 11 degrees
    static constexpr double kWatch = 0.75;   // [s] time constant
    static constexpr double kSettle = 0.3;   // [s] time constant
    static constexpr double kCalmest = 4.0;  // [s] time constant

    // The part of the spring that is felt in this tick.
    Wrench step(const SurfaceNoiseInput& input) noexcept;

    // All of `spring` is felt from here on.
    void settleAt(const Wrench& spring) noexcept;

    bool owes() const noexcept { return owes_; } // more than 1 mN

private:
    // A part of what is owed: along the reaction, or across it.
    struct Part {
        Wrench owed, mean;     // now; over kWatch
        double meanSize = 0.0; // [N] mean of the size of `owed`
        double mostOwed = 0.0; // [N]
        double timeSlow = 0.0; // [s] time constant of what does not stay
    };
    void owe(const SurfaceNoiseInput& input) noexcept;
    void grow(const SurfaceNoiseInput& input, bool contact) noexcept;
    static Wrench paid(const Part& part, double elapsed, double radius) noexcept;

    Wrench spring_;           // of the last tick
    Wrench owed_;             // the part of it that is not yet felt
    Wrench meanOwed_;         // over kWatch
    double meanAlong_ = 0.0;  // [N] mean size of what is owed along the reaction,
    double meanAcross_ = 0.0; // and across it
    double calm_ = kSettle;   // [s] time constant of what does not stay
    double gain_ = 1.0;       // change of the spring per compression by the hand, while the regions rest
    bool owes_ = false;
};

} // namespace fathom
