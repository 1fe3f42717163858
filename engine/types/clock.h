// SPDX-License-Identifier: Apache-2.0
// The host's monotonic clock (CLOCK_MONOTONIC), UTC, and times as numbers. For any thread.
#pragma once

#include <chrono>
#include <cstdint>

namespace fathom {

using Clock = std::chrono::steady_clock; // of all times that are measured

// [s] since the machine started, the same for all of its processes.
inline double secondsOf(Clock::time_point time) noexcept {
    return std::chrono::duration<double>(time.time_since_epoch()).count();
}
inline double monotonicSeconds() noexcept {
    return secondsOf(Clock::now());
}
// [ns] since the machine started.
inline int64_t nanosecondsOf(Clock::time_point time) noexcept {
    return std::chrono::duration_cast<std::chrono::nanoseconds>(time.time_since_epoch()).count();
}

// [ns] of UTC, for messages to other programs.
inline uint64_t utcNanoseconds() noexcept {
    const auto now = std::chrono::system_clock::now().time_since_epoch();
    return static_cast<uint64_t>(std::chrono::duration_cast<std::chrono::nanoseconds>(now).count());
}

// [s]
inline double secondsSince(Clock::time_point begin) noexcept {
    return std::chrono::duration<double>(Clock::now() - begin).count();
}
// [ms]
inline double millis(Clock::time_point begin, Clock::time_point end) noexcept {
    return std::chrono::duration<double, std::milli>(end - begin).count();
}
// [us]
inline double micros(Clock::time_point begin, Clock::time_point end) noexcept {
    return std::chrono::duration<double, std::micro>(end - begin).count();
}

} // namespace fathom
