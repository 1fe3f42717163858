// SPDX-License-Identifier: Apache-2.0
// The clock of a realtime run: seconds since its start on the host's monotonic clock.
#pragma once

#include "engine/types/clock.h"

#include <atomic>
#include <chrono>
#include <cmath>
#include <ctime>

namespace fathom {

// For calls that nothing stops.
inline const std::atomic<bool> kNeverStop{false};

// Call start() before the threads that read the clock. All else is for any thread, noexcept and without
// allocation.
class RunClock {
public:
    using Time = Clock::time_point;

    // Sets t = 0 to `ahead` seconds from now, so that threads can get ready.
    void start(double ahead) noexcept { zero_ = Clock::now() + nanoseconds(ahead); }

    double now() const noexcept { return at(Clock::now()); }
    double at(Time time) const noexcept { return std::chrono::duration<double>(time - zero_).count(); }
    // Time of a CLOCK_MONOTONIC stamp [s], which live cameras and hands use.
    static Time sinceBoot(double stamp) noexcept { return Time(nanoseconds(stamp)); }
    Time timeAt(double t) const noexcept { return zero_ + nanoseconds(t); }

    // Sleeps until t; returns at once when it has passed. Signals do not cut it short.
    void sleepUntil(double t) const noexcept {
        const auto since = timeAt(t).time_since_epoch();
        const auto whole = std::chrono::duration_cast<std::chrono::seconds>(since);
        timespec when{};
        when.tv_sec = static_cast<time_t>(whole.count());
        when.tv_nsec =
            static_cast<long>(std::chrono::duration_cast<std::chrono::nanoseconds>(since - whole).count());
        while (::clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &when, nullptr) != 0) {
        }
    }
    // The same, but returns at most 20 ms after `stop` is set.
    void sleepUntil(double t, const std::atomic<bool>& stop) const noexcept {
        while (!stop.load(std::memory_order_relaxed) && now() < t) {
            sleepUntil(std::fmin(t, now() + 0.02));
        }
    }

private:
    static std::chrono::nanoseconds nanoseconds(double seconds) noexcept {
        return std::chrono::nanoseconds(static_cast<int64_t>(std::llround(seconds * 1e9)));
    }
    Time zero_ = Clock::now();
};

} // namespace fathom
