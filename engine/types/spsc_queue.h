// SPDX-License-Identifier: Apache-2.0
// Single-producer single-consumer queue. The producer never waits: a full queue drops the new value and
// counts it.
#pragma once

#include <atomic>
#include <cstdint>
#include <vector>

namespace fathom {

template <class T>
class SpscQueue {
public:
    // Capacity is rounded up to a power of two. Allocates here and never again.
    explicit SpscQueue(uint64_t capacity) {
        uint64_t size = 1;
        while (size < capacity) {
            size *= 2;
        }
        slots_.resize(size);
    }

    // Producer. False when full; the value is lost and counted in dropped().
    bool push(const T& value) noexcept {
        const uint64_t head = head_.load(std::memory_order_relaxed);
        if (head - tail_.load(std::memory_order_acquire) == slots_.size()) {
            dropped_.fetch_add(1, std::memory_order_relaxed);
            return false;
        }
        slots_[head & (slots_.size() - 1)] = value;
        head_.store(head + 1, std::memory_order_release);
        return true;
    }

    // Consumer. False when empty.
    bool pop(T& value) noexcept {
        const uint64_t tail = tail_.load(std::memory_order_relaxed);
        if (tail == head_.load(std::memory_order_acquire)) {
            return false;
        }
        value = slots_[tail & (slots_.size() - 1)];
        tail_.store(tail + 1, std::memory_order_release);
        return true;
    }

    uint64_t dropped() const noexcept { return dropped_.load(std::memory_order_relaxed); }

private:
    std::vector<T> slots_;
    alignas(64) std::atomic<uint64_t> head_{0};
    alignas(64) std::atomic<uint64_t> tail_{0};
    alignas(64) std::atomic<uint64_t> dropped_{0};
};

} // namespace fathom
