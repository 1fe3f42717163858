// SPDX-License-Identifier: Apache-2.0
#include "engine/types/thread_pool.h"

#include "engine/types/blocked_signals.h"
#include "engine/types/clock.h"

namespace fathom {

namespace {

constexpr uint32_t kPolls = 256; // polls between two reads of the clock, or between two yields

void relax() noexcept {
#if defined(__x86_64__)
    __builtin_ia32_pause();
#elif defined(__aarch64__)
    asm volatile("yield");
#endif
}

uint64_t firstClaim(uint64_t job, uint32_t parts) noexcept {
    return job << 32 | uint64_t{parts} << 16;
}

} // namespace

ThreadPool::ThreadPool(uint32_t workers, std::chrono::microseconds spinTime)
    : spinTime_(spinTime) {
    threads_.reserve(workers - 1);
    const BlockedSignals quiet;
    try {
        for (uint32_t i = 1; i < workers; ++i) {
            threads_.emplace_back([this] { runWorker(); });
        }
    } catch (...) { // std::system_error: threads already started would never end
        end();
        throw;
    }
}

ThreadPool::~ThreadPool() {
    end();
}

void ThreadPool::end() noexcept {
    ending_.store(true);
    wake();
}

void ThreadPool::wake() noexcept {
    wakes_.fetch_add(1, std::memory_order_release);
    wakes_.notify_all();
}

void ThreadPool::runWork(uint32_t parts, const Work& work) noexcept {
    work_ = work;
    done_.store(0, std::memory_order_relaxed);
    const uint64_t job = (claims_.load(std::memory_order_relaxed) >> 32) + 1;
    claims_.store(firstClaim(job, parts), std::memory_order_release);
    wake(); // wakes workers that stopped spinning
    while (takePart()) {
    }
    // Other workers finish their last parts: as short as those done here, unless a thread lost its processor.
    for (uint32_t polls = 1; done_.load(std::memory_order_acquire) < parts; ++polls) {
        if (polls % kPolls == 0) {
            std::this_thread::yield();
        }
        relax();
    }
}

bool ThreadPool::takePart() noexcept {
    uint64_t claim = claims_.load(std::memory_order_acquire);
    do {
        if ((claim & 0xffff) >= (claim >> 16 & 0xffff)) {
            return false;
        }
    } while (!claims_.compare_exchange_weak(claim, claim + 1, std::memory_order_acquire));
    work_.run(work_.job, static_cast<uint32_t>(claim & 0xffff));
    done_.fetch_add(1, std::memory_order_release);
    return true;
}

void ThreadPool::runWorker() noexcept {
    for (;;) {
        // In this order: the wake-up that follows ending_ is either seen here or ends the wait below.
        const uint32_t seen = wakes_.load(std::memory_order_acquire);
        if (ending_.load()) {
            return;
        }
        Clock::time_point until = Clock::now() + spinTime_;
        while (Clock::now() < until) {
            for (uint32_t i = 0; i < kPolls; ++i) {
                if (takePart()) {
                    until = Clock::now() + spinTime_;
                }
                relax();
            }
        }
        wakes_.wait(seen, std::memory_order_acquire);
    }
}

} // namespace fathom
