// SPDX-License-Identifier: Apache-2.0
// Percentiles of repeated measurements (p50, p90, p99), and the clocks for them.
#pragma once

#include <chrono>
#include <cstddef>
#include <vector>

namespace fathom::profile {

// Nearest-rank percentiles of `count` values, in the unit of the values; all zero when count is 0. With fewer
// than 100 values p99 is NaN, because its rank would only be the largest value.
struct Spread {
    double p50 = 0.0, p90 = 0.0, p99 = 0.0;
    size_t count = 0;

    explicit operator bool() const { return count > 0; }
};
Spread spreadOf(std::vector<double> values);

// Cost of one piece of work [ms]: device time by timestamps, time from submission until the host knows the
// result, CPU time of the calling thread, and wall time for host steps with only begin and end times or with
// several threads. The times overlap; none is subtracted from another.
struct Cost {
    Spread gpu, submit, cpu;
    Spread wall = {};
};

// Number of repeats: at least `least`, then until `seconds` have passed or `most` is reached.
struct Repeats {
    size_t least = 10, most = 200;
    double seconds = 0.5;
};

// Wall time and CPU time of the calling thread since construction [ms]. Reading the CPU clock is a system
// call of a fraction of a microsecond. The constructor reads it before the wall clock, so read wallMs()
// first.
class Clocks {
public:
    Clocks();
    double wallMs() const;
    double cpuMs() const;

private:
    double cpu_;
    std::chrono::steady_clock::time_point wall_;
};

// Samples of both clocks for work on one thread [ms].
struct CpuSamples {
    std::vector<double> wall, cpu;

    void take(const Clocks& clocks) {
        wall.push_back(clocks.wallMs());
        cpu.push_back(clocks.cpuMs());
    }
    void add(const CpuSamples& more) {
        wall.insert(wall.end(), more.wall.begin(), more.wall.end());
        cpu.insert(cpu.end(), more.cpu.begin(), more.cpu.end());
    }
    Cost cost() const { return {{}, spreadOf(wall), spreadOf(cpu)}; }
};

// Calls work() as often as `repeats` says and passes each call's clocks to take(clocks). Warms up for a
// quarter of repeats.seconds first, because a GPU left idle during verification restarts at a third of its
// clock.
template <class Work, class Take>
void repeat(const Repeats& repeats, Work&& work, Take&& take) {
    const Clocks warming;
    do {
        work();
    } while (warming.wallMs() < 0.25 * repeats.seconds * 1e3);
    const Clocks whole;
    for (size_t i = 0; i < repeats.most && (i < repeats.least || whole.wallMs() < repeats.seconds * 1e3);
         ++i) {
        const Clocks clocks;
        work();
        take(clocks);
    }
}

// Wall and CPU time of each call, for CPU work without waiting.
template <class Work>
Cost timeCpu(const Repeats& repeats, Work&& work) {
    CpuSamples samples;
    repeat(repeats, work, [&](const Clocks& clocks) { samples.take(clocks); });
    return samples.cost();
}

} // namespace fathom::profile
