// SPDX-License-Identifier: Apache-2.0
// Virtual coupling: the springs between the proxy and the hand, how stiff they may be, and how far from
// unstable they are.
//
// Sampled every T [s], wrench out n ticks after the pose came in, hand or device with physical damping b
// (Colgate and Schenkel 1997): the rendered spring K with damping B (backward difference) is passive when
//     b > (T/2) sup over angles of Re{(1 - e^-jw) H} / (1 - cos w),  H = (K + B (1 - z^-1)/T) z^-n
//       = K T (1 + 2n)/2 + |B|
// exact for n = 0 with any B and for any n with B = 0; otherwise the right side is an upper bound of the
// supremum, so that the rule is safe. A one-pole low-pass with gain a counts as n = (1 - a)/a, exactly
// (limits.h).
#pragma once

#include "engine/haptics/device_preset.h"
#include "engine/types/pose.h"
#include "engine/types/wrench.h"

#include <limits>
#include <optional>

namespace fathom {

// At the tool: base frame, hand map's scale already taken out. All finite.
struct Springs {
    double stiffness = 0.0;           // K_t [N/m]
    double rotationalStiffness = 0.0; // K_r [N m/rad]
    double damping = 0.0;             // B_t [N s/m]
    double rotationalDamping = 0.0;   // B_r [N m s/rad]
    double guidanceStiffness = 0.0;   // K_g [N/m] of guidance mode `paper`, acting beside K_t; else 0
    // k = sqrt(K_r / K_t) [m]: the solver's metric diag(I, k^2 I). Never chosen apart from the springs: only
    // then is the wrench the gradient of the energy that the solver minimises.
    double metricRadius = 0.0;
};

// What the springs are sized from.
struct CouplingOptions {
    double period = 0.001;                     // T [s]
    double delayTicks = 0.0;                   // n
    double handScale = 1.0;                    // of the hand map
    double toolRadius = 0.01;                  // k0 [m]: Tool::gyrationRadius()
    std::optional<double> stiffness;           // [N/m]; empty = auto
    std::optional<double> rotationalStiffness; // [N m/rad]; empty = auto
    double damping = 0.0;                      // B_t [N s/m]
    double rotationalDamping = 0.0;            // B_r [N m s/rad]
    bool paperGuidance = false;                // K_g is wanted
    // Slew limits of the wrench [N/s], [N m/s]: a spring that is stiffer than they can follow lags behind the
    // hand, and a spring that lags feeds it.
    double slewForce = std::numeric_limits<double>::infinity();
    double slewTorque = std::numeric_limits<double>::infinity();
};

// Hands slower than this meet a spring that the slew limits never cut: K <= slew / speed.
inline constexpr double kContactSpeed = 0.25; // [m/s]
inline constexpr double kContactTurn = 2.5;   // [rad/s]

// K_g over K_t in guidance mode `paper`; less when a K_t that the user gave leaves less below the bound.
inline constexpr double kGuidanceShare = 0.25;

// Largest passive stiffness 2 (b - |B|) / (T (1 + 2n)); negative when |B| > b.
double passiveStiffness(double deviceDamping, double damping, double period, double delayTicks) noexcept;

// Auto: K_t + K_g = the smallest of the preset's stiffness, its passive bound and what the slew limit can
// follow, over the hand map's scale s, because the hand feels s K (it moves 1/s of what the tool does;
// hand_map.h). K_r = k0^2 K_t, or its own bound times s (the hand feels K_r / s) when that is lower. With b
// unknown the preset's figure stands alone. k follows from the two. Throws Error when nothing positive is
// left or a number makes no sense.
Springs makeSprings(const DevicePreset& preset, const CouplingOptions& options);

// Margins [N s/m] of the translation at the hand; > 0 = holds. Empty when b is unknown.
struct StabilityMargins {
    std::optional<double> passive; // b - (K T (1 + 2n)/2 + |B|): no hand can be made unstable
    std::optional<double>
        uncoupled; // b + B - K (T/2 + n T): the device left alone is stable (1-3 % optimistic at B = 4 b)
};
StabilityMargins stabilityMargins(const DevicePreset& preset, const Springs& springs,
                                  const CouplingOptions& options);

// Wrench on the hand, base axes, torque about the proxy's centre:
// f = K_t (p - p_dev) + B_t (v_tool - v_dev), tau = K_r log(q q_dev^-1) + B_r (w_tool - w_dev), by the
// shortest arc. slip* = difference of the velocities [m/s], [rad/s].
Wrench couple(const Springs& springs, const Pose& tool, const Pose& device, const dvec3& slip,
              const dvec3& rotationalSlip) noexcept;

} // namespace fathom
