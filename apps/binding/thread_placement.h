// SPDX-License-Identifier: Apache-2.0
// Which thread runs on which CPU: the haptic one alone, everything else elsewhere.
#pragma once

#include <string>
#include <vector>

#include <sched.h>

namespace fathom {

// Of the CPUs that the process may use. One CPU: everything shares it and nothing is pinned.
struct ThreadPlacement {
    std::vector<int> all;
    std::vector<int> haptic;  // the last one
    std::vector<int> contact; // one of its own from four CPUs on, else that of the rest
    std::vector<int> rest;    // camera, device workers, writer

    static ThreadPlacement ofThisProcess();
    bool pinned() const { return all.size() > 1; }
};

// Pins the calling thread. Returns 0, or the error number of the refusal.
int pinThread(const std::vector<int>& cpus) noexcept;

// The calling thread, and every thread that it starts meanwhile (a software device's workers), stay on these
// CPUs for as long as this lives.
class CpuConfinement {
public:
    explicit CpuConfinement(const std::vector<int>& cpus) noexcept;
    CpuConfinement(const CpuConfinement&) = delete;
    CpuConfinement& operator=(const CpuConfinement&) = delete;
    ~CpuConfinement();

private:
    cpu_set_t before_;
    bool changed_ = false;
};

// Makes the calling thread the haptic one: pinned, SCHED_FIFO, exact timers, memory locked as it is touched,
// stack touched. Returns what the system refused, in words; empty when nothing. Call before the first turn.
std::string makeHapticThread(const ThreadPlacement& placement);
// Undoes what outlives the thread (locked memory).
void releaseLockedMemory() noexcept;

} // namespace fathom
