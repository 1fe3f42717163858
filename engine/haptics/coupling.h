// SPDX-License-Identifier: Apache-2.0
// Virtual coupling: the springs between the proxy and the hand, their largest stable stiffness and their
// stability margins. A spring K with damping B (backward difference) is passive (Colgate and Schenkel 1997)
// when
//     b > (T/2) sup over angles of Re{(1 - e^-jw) H} / (1 - cos w),  H = (K + B (1 - z^-1)/T) z^-n
//       = K T (1 + 2n)/2 + |B|
// T [s]: sampling period; n: ticks from pose to wrench; b: physical damping of hand or device. The last line
// is exact for n = 0 with any B and for any n with B = 0, otherwise an upper bound. A one-pole low-pass with
// gain a counts as exactly n = (1 - a)/a (limits.h).
#pragma once

#include "engine/haptics/device_preset.h"
#include "engine/types/pose.h"
#include "engine/types/wrench.h"

#include <limits>
#include <optional>

namespace fathom {

// At the tool, in the base frame, with the scale of the hand map removed. All finite.
struct Springs {
    double stiffness = 0.0;           // K_t [N/m]
    double rotationalStiffness = 0.0; // K_r [N m/rad]
    double damping = 0.0;             // B_t [N s/m]
    double rotationalDamping = 0.0;   // B_r [N m s/rad]
    double guidanceStiffness = 0.0;   // K_g [N/m] of guidance mode `paper`, in parallel with K_t; else 0
    // k = sqrt(K_r / K_t) [m]: the solver's metric diag(I, k^2 I). It must follow from the springs: only then
    // is the wrench the gradient of the energy that the solver minimises.
    double metricRadius = 0.0;
    static constexpr double kMinRadius = 1e-4, kMaxRadius = 10.0; // [m] that every solver can use

    // Sets K_r, moved to the nearest value that k allows, and k. K_t must be positive.
    void setRotational(double wanted) noexcept;
};

// Inputs for sizing the springs.
struct CouplingOptions {
    double period = 0.001;                     // T [s]
    double delayTicks = 0.0;                   // n
    double handScale = 1.0;                    // of the hand map
    double toolRadius = 0.01;                  // k0 [m]: Tool::gyrationRadius()
    std::optional<double> stiffness;           // [N/m]; empty = auto
    std::optional<double> rotationalStiffness; // [N m/rad]; empty = auto
    double damping = 0.0;                      // B_t [N s/m]
    double rotationalDamping = 0.0;            // B_r [N m s/rad]
    double margin = 1.0;                       // share of the passive bound that auto uses
    bool paperGuidance = false;                // also compute K_g
    // Slew limits of the wrench [N/s], [N m/s]: a stiffer spring would lag behind the hand, and a lagging
    // spring feeds energy into it.
    double slewForce = std::numeric_limits<double>::infinity();
    double slewTorque = std::numeric_limits<double>::infinity();
};

// Below these hand speeds the slew limits never cut the spring's wrench: K <= slew / speed.
inline constexpr double kContactSpeed = 0.25; // [m/s]
inline constexpr double kContactTurn = 2.5;   // [rad/s]

// K_g / K_t in guidance mode `paper`. Lower when a user-given K_t leaves less room below the bound.
inline constexpr double kGuidanceShare = 0.25;

// Largest passive stiffness 2 (b - |B|) / (T (1 + 2n)); negative when |B| > b.
double passiveStiffness(double deviceDamping, double damping, double period, double delayTicks) noexcept;

// [N/m] or [N m/rad] at the hand, by the passive bound. figure: the preset's stiffness, deviceDamping: its b,
// damping: B, both at the hand. Without b, the figure is the bound at 1 kHz without delay.
// Empty when neither is known.
std::optional<double> passiveLimit(std::optional<double> figure, std::optional<double> deviceDamping,
                                   double damping, const CouplingOptions& options) noexcept;

// Auto: K_t + K_g is the smallest of the preset's stiffness, a share of the passive bound (margin) and the
// stiffness that the slew limit can follow, divided by the hand map's scale s, because the hand feels s K
// (hand_map.h). K_r = k0^2 K_t, or its own bound times s when that is lower (the hand feels K_r / s). With b
// unknown the bound is passiveLimit(), without margin. k = sqrt(K_r / K_t); a given K_r is moved to where k
// is in its range. Throws Error when no positive stiffness remains or an input is invalid.
Springs makeSprings(const DevicePreset& preset, const CouplingOptions& options);

// Margins [N s/m] of the translation at the hand; > 0 = stable. Empty when b is unknown.
struct StabilityMargins {
    std::optional<double> passive; // b - (K T (1 + 2n)/2 + |B|): > 0: stable with any passive hand
    // b + B - K (T/2 + n T): > 0: stable without a hand (1-3 % optimistic at B = 4 b)
    std::optional<double> uncoupled;
};
// Of springs with the preset's damping and the options' rate and delay.
StabilityMargins stabilityMargins(const DevicePreset& preset, const Springs& springs,
                                  const CouplingOptions& options);

// Wrench of the springs on the hand, base axes, torque about the proxy's centre: f = K_t (p - p_dev),
// tau = K_r log(q q_dev^-1), along the shortest arc. The springs' damping acts elsewhere: WrenchStage.
Wrench couple(const Springs& springs, const Pose& tool, const Pose& device) noexcept;

} // namespace fathom
