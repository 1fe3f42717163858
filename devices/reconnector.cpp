// SPDX-License-Identifier: Apache-2.0
#include "devices/reconnector.h"

#include <chrono>
#include <utility>

#include <unistd.h>

namespace fathom {

namespace {

constexpr auto kSeekPause = std::chrono::milliseconds(100);
static_assert(std::atomic<int>::is_always_lock_free && std::atomic<bool>::is_always_lock_free);

void closeDescriptor(int descriptor) noexcept {
    if (descriptor >= 0) {
        ::close(descriptor);
    }
}

} // namespace

Reconnector::Reconnector(std::function<int()> reopen, std::function<void()> eachRound)
    : reopen_(std::move(reopen))
    , eachRound_(std::move(eachRound)) {
    if (reopen_) {
        seeker_ = std::thread([this] { seek(); });
    }
}

Reconnector::~Reconnector() {
    stop_.store(true);
    if (seeker_.joinable()) {
        seeker_.join();
    }
    closeDescriptor(gone_.exchange(-1));
    closeDescriptor(found_.exchange(-1));
}

void Reconnector::lose(int descriptor) noexcept {
    gone_.store(descriptor); // the thread has already taken the previous one
    seeking_.store(true);
}

void Reconnector::seek() noexcept {
    while (!stop_.load()) {
        std::this_thread::sleep_for(kSeekPause);
        const bool wanted = seeking_.load(); // first: what lose() stored before it is closed below
        closeDescriptor(gone_.exchange(-1));
        if (eachRound_) {
            eachRound_();
        }
        const int next = wanted ? reopen_() : -1;
        if (next >= 0) {
            seeking_.store(false);
            found_.store(next);
        }
    }
}

} // namespace fathom
