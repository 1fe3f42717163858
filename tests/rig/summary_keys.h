// SPDX-License-Identifier: Apache-2.0
// The keys of summary.json, in the order of the file.
#pragma once

#include <string>
#include <vector>

namespace fathom::testing {

using Keys = std::vector<std::string>;

inline const Keys kSummaryKeys{"frames", "haptic",   "contact", "fixtures", "guidance",
                               "device", "lockstep", "digest",  "warnings"};
inline const Keys kFramesKeys{"count",      "skipped", "gpu_ms",       "upload_ms",
                              "latency_ms", "first_s", "answerable_ms"};
inline const Keys kHapticKeys{"ticks",
                              "late",
                              "turn_us",
                              "stalled_ticks",
                              "trapped_ticks",
                              "escape_ticks",
                              "waiting_ticks",
                              "regions_vanished",
                              "index_shift_m",
                              "not_finite_ticks",
                              "max_penetration_m",
                              "max_escape_depth_m",
                              "max_force_N",
                              "max_torque_Nm",
                              "max_force_step_N",
                              "stiffness_N_per_m",
                              "rotational_stiffness_Nm_per_rad",
                              "margin_passive_min",
                              "margin_uncoupled_min",
                              "solver"};
inline const Keys kTimesKeys{"p50", "p99", "max"}, kTickTimesKeys{"p50", "p99", "p999", "max"};
inline const Keys kSolverKeys{"solves_mean", "infeasible"};
inline const Keys kContactKeys{"queries", "spheres_max", "overflows", "query_us", "where"};
inline const Keys kFixtureKeys{"class", "role", "points_mean", "spheres_mean", "patches_mean"};
inline const Keys kGuidanceKeys{"class", "position_m", "normal", "target_m", "target_qwxyz", "count"};

} // namespace fathom::testing
