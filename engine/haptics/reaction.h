// SPDX-License-Identifier: Apache-2.0
// The reaction of the regions: the spring between the hand and the pose that the active rows allow. Without
// an active row it goes to zero, within a frame if new data ended it, however far the tool lags behind.
#pragma once

#include "engine/haptics/coupling.h"
#include "engine/haptics/reaction_fade.h"
#include "engine/haptics/surface_noise.h"
#include "engine/haptics/wrench_metric.h"

namespace fathom {

// Input of one tick, after the proxy has moved.
struct ReactionInput {
    Pose allowed;          // ProxyStep::allowed
    Pose springEnd;        // the hand's end of the spring: device pose plus the guidance lead
    Springs springs;       // active
    double period = 0.001; // T [s]
    double elapsed = 0.0;  // [s] measured since the tick before; less than T counts as T
    bool mayRise = true;  // false: rows have expired, the tool is trapped or the hand's sample is unconfirmed
    bool newData = false; // the regions changed since the tick before
    bool vanished = false; // the regions that pressed, or some of them, are gone although nothing moved
    bool lags = false;     // the tool did not reach `allowed`
    double forceLimit = 1e9, torqueLimit = 1e9; // [N], [N m] delivered at most: what fades begins there
    double rendered = 1e9; // [N] by the device in the last tick, torque counted as torque / k
};

// One thread; noexcept, no allocation. Falls that the hand causes are immediate. A rise beyond the hand's own
// compression has another cause (a row, new data, the end of a lag) and is at most kMaxRiseRate. What new
// data causes is spread over the time between frames, and a part of it is felt later (SurfaceNoise). Times
// are measured ones, so that late ticks delay nothing; a rise counts ticks. All rules:
// docs/architecture/tick.md, "Where does the force come from?"
class Reaction {
public:
    // Wrench on the hand, base axes, before limits; without damping.
    Wrench step(const ReactionInput& input) noexcept;

    // The hand's end of the spring was moved by `by` [m] and turned by `turn`, not by the hand.
    void shift(const dvec3& by, const dquat& turn) noexcept;

    double size() const noexcept { return size_; } // [N] of the last tick, torque counted as torque / k
    bool fades() const noexcept { return fade_.active(); }
    // In the last tick the reaction grew by more than the hand compressed, or new data still changes or turns
    // it: work that the hand did not do.
    bool appears() const noexcept {
        return appears_ || turnLeft_ > 0.0 || held_ > kMinFelt || noise_.withholds();
    }
    // [s] between the last two changes of the regions, at most kLongestFrame.
    double frameInterval() const noexcept { return interval_; }

    static constexpr double kMaxRiseRate = 100.0;  // [N/s]
    static constexpr double kLeavingSpeed = 0.25;  // [m/s] a hand that leaves this fast needs no further rise
    static constexpr double kLongestFrame = 0.033; // [s]

private:
    struct Travel { // of the hand's end of the spring in this tick, not by shift()
        dvec3 moved, turned;
        double length; // [m] metric
    };
    void keepTime(const ReactionInput& input) noexcept;
    Travel travelOf(const Pose& end) noexcept;
    bool pushed() const noexcept;
    double rate(double appeared) noexcept;
    double heldBack(const Wrench& way, double wanted, double byHand, double released,
                    double rendered) noexcept;
    void beginFade(const Wrench& wanted, const ReactionInput& input) noexcept;
    bool beginElsewhere(const Wrench& wanted, const ReactionInput& input) noexcept;
    void fadeLost(const Wrench& wanted, double byHand, const ReactionInput& input) noexcept;
    Wrench withoutNoise(const Wrench& spring, double byHand, const ReactionInput& input) noexcept;
    Wrench limitRise(const Wrench& wrench, const Travel& travel, const ReactionInput& input) noexcept;
    void beginTurn(const Wrench& wrench, const ReactionInput& input) noexcept;
    Wrench turning(const Wrench& wrench, const ReactionInput& input) noexcept;

    double k_ = 1.0; // [m] metric radius of this tick
    Pose end_;       // of the last tick
    SurfaceNoise noise_;
    ReactionFade fade_;
    Wrench lastFelt_;           // of the last tick, what fades included
    double lastFeltSize_ = 0.0; // [N]
    double size_ = 0.0;         // [N] of the last tick, without what fades
    double held_ = 0.0;         // [N] that new data took, and that still falls
    Wrench turnBack_;           // per newton: from the newest direction to the one before the newest data
    double turnedForce_ = 0.0;  // [N] that had the former direction
    double turnLeft_ = 0.0;     // [s] for which a share of it is still taken back
    double elapsed_ = 0.001;    // [s] since the last tick
    double sinceData_ = kLongestFrame, interval_ = kLongestFrame; // [s] since the newest data; between data
    double riseRate_ = kMaxRiseRate;                              // [N/s] until the next frame is due
    bool started_ = false, appears_ = false;
    bool ended_ = false; // the reaction is zero, and only held_ is felt
};

} // namespace fathom
