// SPDX-License-Identifier: Apache-2.0
// Repeated measurements of one thing: p50, p90, p99, and the clocks that they are taken with.
#pragma once

#include <chrono>
#include <cstddef>
#include <vector>

namespace fathom::profile {

// Nearest-rank percentiles of `count` values, in the unit of the values; all zero when count is 0. With fewer
// than 100 values p99 is not a number: by rank it would be the largest of them, whatever that is a rank of.
struct Spread {
    double p50 = 0.0, p90 = 0.0, p99 = 0.0;
    size_t count = 0;

    explicit operator bool() const { return count > 0; }
};
Spread spreadOf(std::vector<double> values);

// What one piece of work costs, in ms. They overlap and none is subtracted from another: device time by
// timestamps, from the submission until its result is known to the host, and CPU time of the calling thread;
// where a step of the host's is known by its begin and end alone, or several threads share it, wall time.
struct Cost {
    Spread gpu, submit, cpu;
    Spread wall = {};
};

// How often a measurement is repeated: at least `least` times, then until `seconds` are over or `most` is
// reached.
struct Repeats {
    size_t least = 10, most = 200;
    double seconds = 0.5;
};

// Wall time and CPU time of the calling thread since construction [ms]. The CPU clock takes a system call, a
// fraction of a microsecond: it is read before the wall's begins, so read wallMs() first.
class Clocks {
public:
    Clocks();
    double wallMs() const;
    double cpuMs() const;

private:
    double cpu_;
    std::chrono::steady_clock::time_point wall_;
};

// Samples of both clocks, of work on one thread [ms].
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

// Calls work() as `effort` says and hands each call's clocks to take(clocks), after calls that warm up for a
// quarter of its seconds: a GPU that verification on the CPU left idle comes back at a third of its clock.
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

// CPU work that waits for nobody: wall and CPU time of each call.
template <class Work>
Cost timeCpu(const Repeats& repeats, Work&& work) {
    CpuSamples samples;
    repeat(repeats, work, [&](const Clocks& clocks) { samples.take(clocks); });
    return samples.cost();
}

} // namespace fathom::profile
