// SPDX-License-Identifier: Apache-2.0
#include "apps/python/unlocked.h"

#include <atomic>
#include <chrono>
#include <thread>
#include <unistd.h>

namespace fathom::python {

namespace {

constexpr auto kPatience = std::chrono::seconds(10); // for calls of other threads

std::atomic<std::thread::id> lastThread{}; // that may return to the interpreter; none = any may
std::atomic<int> inside{0};                // threads without the lock, or on their way back
std::atomic<pid_t> process{::getpid()};    // that of `inside`

// Call with the interpreter's lock. Returns the state of the thread.
PyThreadState* leave() noexcept {
    const pid_t here = ::getpid();
    if (process.exchange(here) != here) { // forked: the other threads do not exist
        inside = 0;
    }
    ++inside;
    return PyEval_SaveThread();
}

} // namespace

Unlocked::Unlocked() noexcept
    : state_(leave()) {}

Unlocked::~Unlocked() {
    if (const auto last = lastThread.load();
        last != std::thread::id() && last != std::this_thread::get_id()) {
        --inside;
        for (;;) {
            ::pause();
        }
    }
    PyEval_RestoreThread(state_);
    --inside;
}

bool usedInThisProcess() noexcept {
    return process == ::getpid();
}

void endInterpreter() noexcept {
    lastThread = std::this_thread::get_id();
    const Unlocked others;
    const auto until = std::chrono::steady_clock::now() + kPatience;
    while (inside > 1 && std::chrono::steady_clock::now() < until) {
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
}

} // namespace fathom::python
