// SPDX-License-Identifier: Apache-2.0
// Triple buffer: passes the newest value from one writer to one reader without locks. Unread values are
// overwritten.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>

namespace fathom {

// The writer fills back() and calls publish(); the reader calls refresh() and reads front(). Each side owns
// its slot, so T may be large and is never copied. Wait-free on both sides; one thread per side.
template <class T>
class TripleBuffer {
public:
    TripleBuffer() = default;
    explicit TripleBuffer(const T& initial) { slots_.fill(initial); }

    T& back() noexcept { return slots_[back_]; }

    void publish() noexcept { back_ = middle_.exchange(back_ | kFresh, std::memory_order_acq_rel) & kIndex; }

    // True when front() changed.
    bool refresh() noexcept {
        if ((middle_.load(std::memory_order_relaxed) & kFresh) == 0) {
            return false;
        }
        front_ = middle_.exchange(front_, std::memory_order_acq_rel) & kIndex;
        return true;
    }

    const T& front() const noexcept { return slots_[front_]; }

private:
    static constexpr uint32_t kIndex = 3;
    static constexpr uint32_t kFresh = 4;
    std::array<T, 3> slots_{};
    alignas(64) uint32_t back_ = 0;
    alignas(64) uint32_t front_ = 1;
    alignas(64) std::atomic<uint32_t> middle_{2};
};

} // namespace fathom
