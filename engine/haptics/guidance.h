// SPDX-License-Identifier: Apache-2.0
// Guidance pulls the hand towards a target, in one of two modes, while a button is held. It fades in and out.
#pragma once

#include "engine/contact/host_fixtures.h"
#include "engine/haptics/coupling.h"
#include "engine/types/pose.h"
#include "engine/types/wrench.h"

#include <limits>
#include <span>

namespace fathom {

// Limits of the strength of guidance and of its rate of change.
struct GuidanceLimits {
    double force = 2.0;     // F_g [N]: largest force
    double torque = 0.1;    // tau_g [N m] largest torque
    double easeTime = 0.5;  // [s] for w from 0 to 1 and back, smoothstep
    double holdTime = 0.5;  // [s] a target is kept after its class fell below min_count
    double speed = 0.1;     // [m/s] limit of the target and of the pulled tool
    double turnSpeed = 0.5; // [rad/s]
};

// Largest distance from the hand to the point that pulls it.
struct GuidanceReach {
    double length = std::numeric_limits<double>::infinity(); // [m]
    double angle = std::numeric_limits<double>::infinity();  // [rad]
};

// One thread, noexcept, no allocation. Hold, slew and choice act on the target only; the reported mean stays
// raw.
//
// What pulls is a point ahead of the hand, on the way to the target. It moves at most at the limits' speed. A
// hand that is faster by itself catches up with it and is then pulled by nothing.
class Guidance {
public:
    explicit Guidance(const GuidanceLimits& limits = {})
        : limits_(limits) {}

    // One tick. poses: one per guidance class, of the newest frame. Pressing the button chooses the nearest
    // present class (if none is present, the first that appears) and keeps it until release, even while it is
    // lost. Without a plane the stand-off keeps its direction from then on, wherever the camera goes. The
    // pull of a roll that becomes free, or is no longer, fades out or in. cut = true (forces off) takes w
    // to 0 within the time of a ramp (ForceRamps); the button must then be pressed again.
    void step(std::span<const GuidancePose> poses, const Pose& device, bool button, bool cut, double dt,
              const GuidanceReach& reach = {}) noexcept;
    // The pose that the hand commands was moved by `by` [m] and turned by `turn`, not by the hand.
    void shift(const dvec3& by, const dquat& turn) noexcept {
        device_ = {device_.position + by, turn * device_.rotation};
    }
    // Reach of a lead (see below), or of the pull of mode `paper`, at full weight.
    GuidanceReach leadReach(const Springs& springs) const noexcept;
    GuidanceReach pullReach(const Springs& springs) const noexcept;

    double weight() const noexcept { return weight_; } // w, 0..1
    bool hasTarget() const noexcept { return chosen_ >= 0; }
    int chosen() const noexcept { return chosen_; }         // index into poses; -1 = none
    const Pose& target() const noexcept { return target_; } // held and slewed

    // Offset added to the solver's target x_u in mode `target`: [w clamp(p_g - p_dev, F_g/K_t);
    // w clamp(log(q_g q_dev^-1), tau_g/K_r)], less where the speed limits it. The pull at rest is then at
    // most F_g and tau_g, and the proxy leads the hand by at most F_g/K_t. With free roll only the axis
    // rotates, not about the target's z.
    struct Lead {
        dvec3 translation{0.0}; // [m]
        dvec3 rotation{0.0};    // [rad] base axes
    };
    Lead lead(const Pose& device, const Springs& springs) const noexcept;

    // Wrench added in mode `paper`: w K_g (p_g - p_dev), at most F_g, and w K_gr (rotation),
    // at most tau_g, K_gr = k^2 K_g; less where the speed limits it.
    Wrench pull(const Pose& device, const Springs& springs) const noexcept;

private:
    double easeStep(double dt) const noexcept { return limits_.easeTime > 0.0 ? dt / limits_.easeTime : 1.0; }
    void choose(std::span<const GuidancePose> poses, const Pose& device) noexcept;
    void follow(std::span<const GuidancePose> poses, double dt) noexcept;
    void advance(const Pose& device, const GuidanceReach& reach, double dt) noexcept;
    dvec3 turnFrom(const Pose& device) const noexcept;
    dvec3 ahead(const dvec3& way, double reach, double most) const noexcept;

    GuidanceLimits limits_;
    int chosen_ = -1;
    bool waiting_ = false; // button down, no class present yet
    bool button_ = false;
    bool cut_ = false;   // forces went off; until w is 0
    double roll_ = 0.0;  // share of the target's roll that pulls: 0 when its roll is free
    double lost_ = 0.0;  // [s] since the chosen class was last present
    double phase_ = 0.0; // 0..1, linear in time
    double weight_ = 0.0;
    Pose target_;
    dvec3 standoff_{0.0};     // [m] when the class was chosen
    Pose device_;             // of the last step
    double ahead_ = 0.0;      // [m] from the hand to the point that pulls
    double aheadAngle_ = 0.0; // [rad]
};

// Shortest rotation that brings the z axis of `from` onto that of `to`, base axes [rad]. It has no component
// about either z axis.
dvec3 axisTurn(const dquat& from, const dquat& to) noexcept;

} // namespace fathom
