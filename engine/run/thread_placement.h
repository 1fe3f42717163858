// SPDX-License-Identifier: Apache-2.0
// Assigns threads to CPUs: the haptic thread has its own, all others share the rest.
#pragma once

#include <string>
#include <vector>

#include <sched.h>

namespace fathom {

// Splits the CPUs that the process may use. With one CPU nothing is pinned.
struct ThreadPlacement {
    std::vector<int> all;
    std::vector<int> haptic;  // the last CPU
    std::vector<int> contact; // a CPU of its own with four CPUs or more, else as `rest`
    std::vector<int> rest;    // frame thread, device workers, writer

    static ThreadPlacement ofThisProcess();
    bool pinned() const { return all.size() > 1; }
};

// Pins the calling thread. Returns 0 or an error number.
int pinThread(const std::vector<int>& cpus) noexcept;

// Keeps the calling thread, and every thread that it starts meanwhile (workers of a software device), on
// these CPUs while this lives.
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

// Makes the calling thread the haptic thread: pinned, SCHED_FIFO, exact timers, touched memory locked, stack
// touched. Returns a text that names what the system rejected, or an empty one. Call before the first step.
std::string makeHapticThread(const ThreadPlacement& placement);
// Undoes what would outlive the thread (locked memory).
void releaseLockedMemory() noexcept;

} // namespace fathom
