// SPDX-License-Identifier: Apache-2.0
#include "engine/run/thread_placement.h"

#include <cerrno>
#include <cstring>

#include <pthread.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>

namespace fathom {

namespace {

constexpr int kHapticPriority =
    80; // of 1..99: above the threads of most drivers, below the kernel's watchdogs
constexpr size_t kStackTouched = 256 * 1024; // [bytes] more than a step uses
constexpr size_t kCpusForOwnContact = 4;

__attribute__((noinline)) void touchStack() noexcept {
    volatile char stack[kStackTouched];
    for (size_t i = 0; i < kStackTouched; i += 1024) {
        stack[i] = 0;
    }
    (void)stack[0];
}

void add(std::string& refused, const char* what, int fault) {
    refused += (refused.empty() ? "" : ", ") + std::string(what) + " (" + std::strerror(fault) + ")";
}

// Locks pages when they are touched: locking whole stacks and driver reservations would make unused memory
// resident. Under a finite limit every later mapping of any thread counts in full and fails above the limit,
// so later mappings are locked only without a limit. A step maps nothing.
int lockMemory() noexcept {
    const rlimit none{RLIM_INFINITY, RLIM_INFINITY};
    const bool unlimited = ::setrlimit(RLIMIT_MEMLOCK, &none) == 0;
    const int flags = MCL_CURRENT | MCL_ONFAULT | (unlimited ? MCL_FUTURE : 0);
    return ::mlockall(flags) == 0 ? 0 : errno;
}

} // namespace

ThreadPlacement ThreadPlacement::ofThisProcess() {
    ThreadPlacement p;
    cpu_set_t allowed;
    CPU_ZERO(&allowed);
    if (::sched_getaffinity(0, sizeof allowed, &allowed) != 0) {
        return p;
    }
    for (int cpu = 0; cpu < CPU_SETSIZE; ++cpu) {
        if (CPU_ISSET(cpu, &allowed)) {
            p.all.push_back(cpu);
        }
    }
    p.rest = p.all;
    p.haptic = {p.all.back()};
    if (p.pinned()) {
        p.rest.pop_back();
    }
    p.contact = p.rest;
    if (p.all.size() >= kCpusForOwnContact) {
        p.contact = {p.rest.back()};
        p.rest.pop_back();
    }
    return p;
}

int pinThread(const std::vector<int>& cpus) noexcept {
    cpu_set_t set;
    CPU_ZERO(&set);
    for (int cpu : cpus) {
        CPU_SET(cpu, &set);
    }
    return ::pthread_setaffinity_np(::pthread_self(), sizeof set, &set);
}

CpuConfinement::CpuConfinement(const std::vector<int>& cpus) noexcept {
    changed_ =
        ::pthread_getaffinity_np(::pthread_self(), sizeof before_, &before_) == 0 && pinThread(cpus) == 0;
}

CpuConfinement::~CpuConfinement() {
    if (changed_) {
        ::pthread_setaffinity_np(::pthread_self(), sizeof before_, &before_);
    }
}

std::string makeHapticThread(const ThreadPlacement& placement) {
    std::string refused;
    if (const int fault = placement.pinned() ? pinThread(placement.haptic) : 0; fault != 0) {
        add(refused, "a CPU of its own", fault);
    }
    sched_param priority{};
    priority.sched_priority = kHapticPriority;
    if (const int fault = ::pthread_setschedparam(::pthread_self(), SCHED_FIFO, &priority); fault != 0) {
        add(refused, "real-time priority", fault);
    }
    ::prctl(PR_SET_TIMERSLACK, 1, 0, 0,
            0); // [ns] the default delays wake-ups by 50 us without real-time priority
    if (const int fault = lockMemory(); fault != 0) {
        add(refused, "locked memory", fault);
    }
    touchStack();
    return refused;
}

void releaseLockedMemory() noexcept {
    ::munlockall();
}

} // namespace fathom
