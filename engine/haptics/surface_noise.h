// SPDX-License-Identifier: Apache-2.0
// Keeps the noise of a sensor out of the reaction: what new data changes in the spring is felt slowly, what
// the hand changes at once.
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

// One thread; noexcept, no allocation. Withholds a part of the force that new data changes and releases it
// slowly: along the reaction at most kBand of the surface's motion, across it kBand or kTurnBand of the
// reaction if that is more; never more than half of the reaction, so that force ends where contact ends.
//
// A change that stays is released with kSettle: then the mean over kWatch of the withheld force is near its
// size, while noise keeps it near zero. The rest is released with a time constant that grows while the hand
// rests on the surface, up to kMaxSlowTime. What is withheld across the reaction also ends within some
// millimetres of travel (docs/architecture/tick.md, "Where does the force come from?").
class SurfaceNoise {
public:
    static constexpr double kBand = 0.002;      // [m] of motion of the surface
    static constexpr double kTurnBand = 0.2;    // share of the reaction: 11 degrees
    static constexpr double kWatch = 0.75;      // [s] time constant
    static constexpr double kSettle = 0.3;      // [s] time constant
    static constexpr double kMaxSlowTime = 4.0; // [s] time constant

    // The part of the spring that is felt in this tick.
    Wrench step(const SurfaceNoiseInput& input) noexcept;

    // All of `spring` is felt from here on.
    void settleAt(const Wrench& spring) noexcept;

    bool withholds() const noexcept { return withholds_; } // more than 1 mN

private:
    // A part of the withheld force: along the reaction, or across it.
    struct Part {
        Wrench withheld, mean; // now; over kWatch
        double meanSize = 0.0; // [N] mean of the size of `withheld`
        double most = 0.0;     // [N]
        double slowTime = 0.0; // [s] time constant of a change that does not stay
    };
    void withhold(const SurfaceNoiseInput& input) noexcept;
    void adaptSlowTime(const SurfaceNoiseInput& input, bool contact) noexcept;
    static Wrench stillWithheld(const Part& part, double elapsed, double radius) noexcept;

    Wrench spring_;             // of the last tick
    Wrench withheld_;           // the part of it that is not yet felt
    Wrench meanWithheld_;       // over kWatch
    double meanAlong_ = 0.0;    // [N] mean size of the withheld force along the reaction,
    double meanAcross_ = 0.0;   // and across it
    double slowTime_ = kSettle; // [s] time constant of a change that does not stay
    double gain_ = 1.0;         // change of the spring per compression by the hand, while the regions rest
    bool withholds_ = false;
};

} // namespace fathom
