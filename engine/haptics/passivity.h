// SPDX-License-Identifier: Apache-2.0
// Time-domain passivity. An observer counts the energy that the fixtures generate: what they give to the hand
// without having received it. A controller takes it back by damping (Hannaford and Ryu 2002; stored energy as
// the reference, Ryu et al. 2005).
//
// The wrench w is constant over a tick while the hand's end of the spring moves by dx, so that the hand
// receives exactly w . dx. With the energy S stored in the spring and the device's own damping b, a tick
// generates
//     G = w . dx + (S - S_before) - b |dx|^2 / T,         |dx|^2 / T <= integral of v^2 over the tick.
// A fixture that stands still never generates when K <= 2 b / T: the proxy may always stay where it was, so
// S <= K/2 |p_before - x|^2 = S_before - w . dx + K/2 |dx|^2, hence G <= (K/2 - b/T) |dx|^2 <= 0. That holds
// for any region and any hand path, and for rotations too (the Hessian of |log q|^2 / 2 is at most 1): there
// the controller does nothing. A surface that jumps by delta at penetration p makes S larger by K p delta +
// K delta^2 / 2, and all of it is counted in the same tick, before the hand receives any.
#pragma once

#include "engine/haptics/coupling.h"

#include <array>
#include <cstdint>

namespace fathom {

// All at the tool (hand map's scale taken out).
struct PassivityOptions {
    double damping = 0.0;           // b [N s/m]
    double rotationalDamping = 0.0; // b_r [N m s/rad]
    double metricRadius = 0.1;      // k [m]: weighs rotation against translation, as in the springs
    double forceLimit = 20.0,
           torqueLimit = 2.0; // [N], [N m] of the size limit: a spring beyond it stores less
    uint32_t delayTicks = 0;  // whole ticks from a wrench to the hand, 0..64
};

// b from the preset. Where b is unknown: the value with which the preset's stiffness is just passive at 1
// kHz, because that is how the stiffness was found. Where b_r is unknown: the value with which K_r is just
// passive.
PassivityOptions makePassivity(const DevicePreset& preset, const Springs& springs,
                               const CouplingOptions& coupling, double forceLimit, double torqueLimit);

// Input of the observer for one tick, after the proxy has moved.
struct PassivityStep {
    Pose device;           // base_T_tool that the hand commands
    Pose end;              // hand's end of the spring: device, led by guidance
    Wrench contact;        // of the springs between end and proxy, unscaled, on actuated axes
    double share = 1.0;    // of the wrench that the ramps let through; 0 forgets everything
    Springs springs;       // active
    double period = 0.001; // T [s] since the tick before
};

// One thread; noexcept, no allocation. Translation and rotation are damped separately but share one energy
// account: a lever converts the energy of one into that of the other without generating any.
class PassivityController {
public:
    explicit PassivityController(const PassivityOptions& options);

    // Observes the interval that ends now and returns what to add to the wrench: -alpha v and -alpha k^2 w
    // with alpha = debt / (T (v.v + k^2 w.w)), capped (kMostDamping, kMostImpulse); zero below kSlow,
    // kSlowTurn.
    Wrench step(const PassivityStep& tick) noexcept;
    // What the device receives from now on: the part of the springs and the part that step() added.
    void delivered(const Wrench& contact, const Wrench& damper) noexcept;
    void reset() noexcept;

    double debt() const noexcept { return debt_; }           // [J] > 0 = generated and not yet taken back
    double generated() const noexcept { return generated_; } // [J] sum of what was counted as generated
    double taken() const noexcept { return taken_; }         // [J] sum of what the damping took

    static constexpr double kSlow = 1e-4;     // [m/s] slower than this a hand is not damped
    static constexpr double kSlowTurn = 1e-3; // [rad/s]
    // The damper: at most so many times b, and so many N s^2/m over T (1 + 2n), n ticks of delay: 20 N s/m at
    // 1 kHz. A device of 50 g is then slowed by at most 0.4 of its speed per tick; sampled damping
    // becomes unstable near 1.
    static constexpr double kMostDamping = 40.0;
    static constexpr double kMostImpulse = 0.02;
    static constexpr double kTolerance = 1e-6; // [J] debts below it are rounding of the solver
    static constexpr double kForget =
        0.5;                              // [s] time constant that forgets a debt which damping could not pay
    static constexpr size_t kWindow = 30; // ticks whose dissipation may offset later generation

private:
    struct Applied {
        Wrench contact, damper;
    };
    static constexpr size_t kMostDelay = 64;

    double storedIn(const PassivityStep& tick) const noexcept;
    void observe(const PassivityStep& tick) noexcept;
    Wrench control(const PassivityStep& tick) const noexcept;

    PassivityOptions options_;
    std::array<Applied, kMostDelay + 1> applied_{};
    std::array<double, kWindow> credit_{}; // [J] dissipated by b, per tick
    size_t writes_ = 0, ticks_ = 0;
    double recent_ = 0.0; // sum of credit_
    bool started_ = false;
    Pose device_, end_;              // at the tick before
    dvec3 moved_{0.0}, turned_{0.0}; // of the device since then
    double stored_ = 0.0, debt_ = 0.0, generated_ = 0.0, taken_ = 0.0;
};

} // namespace fathom
