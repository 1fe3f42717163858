// SPDX-License-Identifier: Apache-2.0
// Time-domain passivity (Hannaford and Ryu 2002; stored energy as the reference, Ryu et al. 2005). Measures
// the energy that fixtures give to the hand beyond what they received, and dissipates it by damping.
//
// The wrench w is constant over a tick while the hand's end of the spring moves by dx. With the energy S
// stored in the spring and the device's damping b, a tick generates
//     G = w . dx + (S - S_before) - b |dx|^2 / T,         |dx|^2 / T <= integral of v^2 over the tick.
// The proxy may always stay where it was, so S <= S_before - w . dx + K/2 |dx|^2 and G <= (K/2 - b/T) |dx|^2:
// a static fixture generates nothing when K <= 2 b / T, for any region and hand path, and for rotations (the
// Hessian of |log q|^2 / 2 is at most 1). A surface that jumps by delta at penetration p adds
// K p delta + K delta^2 / 2 to S in the same tick. Fades: docs/architecture/tick.md,
// "How is energy controlled?"
#pragma once

#include "engine/haptics/coupling.h"

#include <array>
#include <cstdint>

namespace fathom {

// All at the tool (scale of the hand map removed).
struct PassivityOptions {
    double damping = 0.0;           // b [N s/m]
    double rotationalDamping = 0.0; // b_r [N m s/rad]
    double metricRadius = 0.1;      // k [m]: weight of rotation against translation, as in the springs
    uint32_t delayTicks = 0;        // whole ticks from a wrench to the hand, 0..64
    AxisMask actuated{true, true, true, true, true, true}; // only these are credited with b, and damped
};

// b from the preset. If b is unknown, the value at which the preset's stiffness is just passive at 1 kHz,
// because the stiffness was found that way. If b_r is unknown, the value at which K_r is just passive.
PassivityOptions makePassivity(const DevicePreset& preset, const Springs& springs,
                               const CouplingOptions& coupling);

// Input of the observer for one tick, after the proxy has moved.
struct PassivityStep {
    Pose device;                           // base_T_tool that the hand commands
    Pose springEnd;                        // hand's end of the spring: device pose plus the guidance lead
    dquat baseRhandle{1.0, 0.0, 0.0, 0.0}; // frame of the actuated axes
    Wrench contact;                        // reaction of the regions, unscaled, on actuated axes
    bool rows = true;                      // some row is active, or its reaction still falls
    // The reaction grew without the hand, because new data moved a surface, or a lever may give back energy
    // of the hand that the springs do not count.
    bool appears = false;
    double repay = 0.033; // [s] in which the energy of such a tick is dissipated: the time between frames
    double forceLimit = 20.0, torqueLimit = 2.0; // [N], [N m] active: a spring beyond them stores less
    double fadeGain = 1.0;                       // 0..1, factor of all fades; 0 forgets any debt
    Springs springs;                             // active
    double elapsed = 0.001;                      // T [s] measured since the tick before; nominal in lockstep
};

// One thread; noexcept, no allocation. Translation and rotation are damped separately but share one energy
// account: a lever converts one into the other without generating energy.
class PassivityController {
public:
    explicit PassivityController(const PassivityOptions& options);

    // Observes the interval that ends now and returns the damping wrench to add: -alpha v and -alpha k^2 w
    // with alpha = debt / (T (v.v + k^2 w.w)), capped (kMaxDamping, kMaxImpulse). What appeared is divided
    // by `repay` instead of T, and damped by the same law along the reaction alone while the hand slides. A
    // push of the springs becomes weaker, and never a pull. More while the springs push the hand out
    // (release()); zero below kMinSpeed, kMinTurnSpeed. Without an active row it is at most kFreeDamper and
    // ends at kFreeTime; energy that remains then is not removed.
    Wrench step(const PassivityStep& tick) noexcept;
    // The wrench sent to the device from now on: the springs' part and the part that step() added.
    void delivered(const Wrench& contact, const Wrench& damper) noexcept;
    void reset() noexcept;
    // The hand's end of the spring was moved by `by` [m] and turned by `turn`, not by the hand.
    void shift(const dvec3& by, const dquat& turn) noexcept;

    // [J] > 0 = generated and not yet dissipated; for tests
    double debt() const noexcept { return debt_; }
    double generated() const noexcept { return generated_; }   // [J] total energy generated
    double dissipated() const noexcept { return dissipated_; } // [J] total, by the controller
    // [J] that the hand put in and that fades took from the springs
    double given() const noexcept { return given_; }

    static constexpr double kMinSpeed = 1e-4;     // [m/s] a slower hand is not damped
    static constexpr double kMinTurnSpeed = 1e-3; // [rad/s]
    // Limits of the damping: a multiple of b, and an impulse [N s^2/m] divided by T (1 + 2n) with n ticks of
    // delay: 20 N s/m at 1 kHz. A device of 50 g then loses at most 0.4 of its speed per tick; sampled
    // damping becomes unstable near 1.
    static constexpr double kMaxDamping = 40.0;
    static constexpr double kMaxImpulse = 0.02;
    // The same for a hand that moves out. It only weakens the springs' push, so it can be larger.
    static constexpr double kMaxRelease = 0.1;
    // Smaller debts, relative to the stored energy, are sensor noise: `repay` removes them.
    static constexpr double kMinDebtRatio = 0.25;
    // [m/s] up to here a hand is at rest, and from twice it on it slides: then what new data generated is
    // damped along the reaction alone.
    static constexpr double kRestingSpeed = 0.005;
    static constexpr double kFreeDamper = 0.99; // [N] largest damping force without an active row
    static constexpr double kFreeTime = 0.09;   // [s] longest time of it
    static constexpr double kFreeEnd = 0.03;    // [s] in which it ends then, without a click
    static constexpr double kTolerance = 1e-6;  // [J] smaller debts are rounding of the solver
    // [s] time constant to forget a debt beyond the energy that the springs hold: it cannot come back.
    static constexpr double kForget = 0.5;
    static constexpr size_t kWindow = 30; // ticks whose dissipation can offset later generation

private:
    struct Applied {
        Wrench contact, damper;
    };
    struct Power { // [W] that the damping dissipates
        double anyMotion, alongReaction;
    };
    struct Ramp { // what scales and limits the springs
        double gain = 1.0, force = 0.0, torque = 0.0;
        bool operator==(const Ramp&) const = default;
    };
    static constexpr size_t kMaxDelay = 64;

    double storedIn(const PassivityStep& tick, const Ramp& ramp) const noexcept;
    double heldBack(const PassivityStep& tick) const noexcept;
    void begin(const PassivityStep& tick) noexcept;
    void rest(const PassivityStep& tick) noexcept;
    void observe(const PassivityStep& tick) noexcept;
    void settle(const PassivityStep& tick, double generated, double fromHand) noexcept;
    void rememberCredit(double credit) noexcept;
    Wrench actuated(const PassivityStep& tick, const dvec3& moved, const dvec3& turned) const noexcept;
    void giveUpWithoutRows(const PassivityStep& tick) noexcept;
    const Wrench& newest() const noexcept { // the springs' part that was sent last
        return applied_[(writes_ + options_.delayTicks) % (options_.delayTicks + 1)].contact;
    }
    Power power(const PassivityStep& tick, double owed, double speed) const noexcept;
    double release(const PassivityStep& tick, double returned, double pushed, double owed) const noexcept;
    Wrench control(const PassivityStep& tick) const noexcept;

    PassivityOptions options_;
    std::array<Applied, kMaxDelay + 1> applied_{};
    Ramp ramp_;                            // of the previous tick
    double given_ = 0.0;                   // [J]
    std::array<double, kWindow> credit_{}; // [J] dissipated by b, per tick
    size_t writes_ = 0, ticks_ = 0;
    double recent_ = 0.0; // sum of credit_
    bool started_ = false;
    Pose device_, springEnd_;        // at the previous tick
    dvec3 moved_{0.0}, turned_{0.0}; // device motion since then
    double stored_ = 0.0, debt_ = 0.0, generated_ = 0.0, dissipated_ = 0.0;
    double dataDebt_ = 0.0;        // [J] part of debt_ that new data caused
    double timeWithoutRows_ = 0.0; // [s] since the last active row
};

} // namespace fathom
