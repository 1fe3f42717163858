// SPDX-License-Identifier: Apache-2.0
// Chooses a point of error against time. Pure functions of measured values: equal points give equal choices.
#pragma once

#include <cmath>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace fathom::tune {

// What the user asks for: exactly one of the two.
struct Request {
    std::optional<double> error; // [mm] largest error of the felt surface
    std::optional<double> time;  // [ms] longest time from camera to force

    std::string text() const; // "error at most 0.2 mm"
};

// The measured values that a choice depends on.
struct Score {
    double error = NAN;   // [mm] RMS error of the felt surface
    double time = NAN;    // [ms] from camera to force, p50
    double ripple = NAN;  // [N] of the force in 10 to 35 Hz, which a hand feels as vibration
    std::string why = {}; // why it cannot be chosen; empty = it can

    bool valid() const { return std::isfinite(error) && std::isfinite(ripple) && time > 0.0; }
};

// Differences that do not count, because repeats differ by as much.
inline constexpr double kSameValue = 1.10;  // ratio of two times or two errors
inline constexpr double kSameRipple = 1.10; // ratio of two ripples

// Whether a point can be chosen and is within the limit.
bool meets(const Score& score, const Request& request);

// For each point whether no other point is at most as slow and at most as wrong, and better in one of both.
// Points that are not valid are not on the front.
std::vector<bool> frontOf(const std::vector<Score>& scores);
// The fastest point that keeps `scores[at]` off the front; none when it is on the front or not valid.
std::optional<size_t> dominatorOf(const std::vector<Score>& scores, size_t at);

// The result of choose().
struct Choice {
    std::optional<size_t> point; // meets the request; none when no point does
    // The point that misses the request by the smallest factor; of points that cannot be chosen, too, when
    // `nearestOpen` is false. None without a valid point.
    std::optional<size_t> nearest;
    bool nearestOpen = true;
};

// Among the points that meet the request: the fastest for a largest error, the least error for a longest
// time. Points within kSameValue of it count as equal; of these, the ones with least ripple, within
// kSameRipple; of these, the first in the list. Put the settings of today first, so that they change for a
// reason only.
Choice choose(const std::vector<Score>& scores, const Request& request);

} // namespace fathom::tune
