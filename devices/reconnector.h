// SPDX-License-Identifier: Apache-2.0
// Reopens a lost device on a thread of its own.
#pragma once

#include <atomic>
#include <functional>
#include <thread>

namespace fathom {

// lose() and take() belong to one thread, the haptic one, and are wait-free: close() and open() may block in
// the kernel, so this thread calls them, ten times per second.
class Reconnector {
public:
    // reopen: returns a descriptor, or -1 while the device is absent; called after lose() until it succeeds.
    // eachRound: called ten times per second, also while nothing is lost. Both run on the thread, must not
    // throw, and may be empty. Without reopen there is no thread, and nothing comes back.
    explicit Reconnector(std::function<int()> reopen, std::function<void()> eachRound = {});
    Reconnector(const Reconnector&) = delete;
    Reconnector& operator=(const Reconnector&) = delete;
    ~Reconnector(); // joins the thread, at most 0.1 s and one call later, and closes what is left

    // Takes the descriptor, which is closed later, and begins to search.
    void lose(int descriptor) noexcept;
    // The descriptor of the device that was found; -1 if there is none. It belongs to the caller.
    int take() noexcept { return found_.exchange(-1); }

private:
    void seek() noexcept; // body of the thread

    std::function<int()> reopen_;
    std::function<void()> eachRound_;
    std::atomic<int> gone_{-1}, found_{-1}; // descriptors, to the thread and back; -1 = none
    std::atomic<bool> seeking_{false}, stop_{false};
    std::thread seeker_;
};

} // namespace fathom
