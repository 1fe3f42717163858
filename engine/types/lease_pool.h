// SPDX-License-Identifier: Apache-2.0
// Pool of values: readers lease the newest one while one writer fills another. Neither side waits.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <stdexcept>
#include <utility>
#include <vector>

namespace fathom {

// Holds readers + 2 values: the newest, one per reader, one to write. Each reader holds at most one lease at
// a time and drops it before it takes the next. One writer. Lock-free; the writer is wait-free.
//
// A value can be published in two steps. After publishEarly() the writer may still write those parts of it
// that no reader of newestEarly() reads; publish() ends that.
template <class T>
class LeasePool {
    struct Entry {
        std::unique_ptr<T> value;
        alignas(64) std::atomic<int32_t> readers{0}; // kWriting while the writer owns it
    };

public:
    // Move-only lease of one value; a default lease is empty.
    class Lease {
    public:
        Lease() = default;
        Lease(Lease&& other) noexcept
            : entry_(std::exchange(other.entry_, nullptr)) {}
        Lease& operator=(Lease&& other) noexcept {
            std::swap(entry_, other.entry_);
            return *this;
        }
        ~Lease() {
            if (entry_ != nullptr) {
                entry_->readers.fetch_sub(1, std::memory_order_release);
            }
        }
        explicit operator bool() const { return entry_ != nullptr; }
        const T& operator*() const { return *entry_->value; }
        const T* operator->() const { return entry_->value.get(); }

    private:
        friend class LeasePool;
        explicit Lease(Entry* entry)
            : entry_(entry) {}
        Entry* entry_ = nullptr;
    };

    // make() builds one value; called readers + 2 times.
    template <class Make>
    LeasePool(uint32_t readers, Make&& make)
        : entries_(readers + 2) {
        for (Entry& entry : entries_) {
            entry.value = make();
        }
    }

    // Reader. Leases the newest published value; empty before the first publish().
    Lease newest() noexcept { return leaseOf(newest_); }
    // Reader. The same after either step: never older than newest().
    Lease newestEarly() noexcept { return leaseOf(early_); }

    // Writer. A value that is neither the newest nor leased; stays the same until publish(), also after
    // publishEarly().
    T& back() noexcept {
        if (writing_ < 0) {
            for (size_t i = 0; writing_ < 0; i = (i + 1) % entries_.size()) {
                int32_t none = 0;
                if (static_cast<int32_t>(i) != newest_.load(std::memory_order_relaxed) &&
                    entries_[i].readers.compare_exchange_strong(none, kWriting, std::memory_order_acquire)) {
                    writing_ = static_cast<int32_t>(i);
                }
            }
        }
        return *entries_[static_cast<size_t>(writing_)].value;
    }
    uint32_t backIndex() const noexcept { return static_cast<uint32_t>(writing_); } // after back()

    // Writer. The value of back() becomes the newest for newestEarly(). At most once before publish().
    void publishEarly() noexcept {
        entries_[static_cast<size_t>(writing_)].readers.store(0, std::memory_order_release);
        early_.store(writing_, std::memory_order_release);
    }
    // Writer. The value of back() becomes the newest.
    void publish() noexcept {
        if (early_.load(std::memory_order_relaxed) != writing_) {
            publishEarly();
        }
        newest_.store(writing_, std::memory_order_release);
        writing_ = -1;
    }

    size_t size() const { return entries_.size(); }
    // For setting up values before the threads start.
    T& at(size_t i) { return *entries_[i].value; }
    // Any thread. `value` must be one of the pool: throws std::logic_error.
    size_t indexOf(const T& value) const {
        for (size_t i = 0; i < entries_.size(); ++i) {
            if (entries_[i].value.get() == &value) {
                return i;
            }
        }
        throw std::logic_error("a value of another pool");
    }

private:
    Lease leaseOf(const std::atomic<int32_t>& which) noexcept {
        for (;;) {
            const int32_t index = which.load(std::memory_order_acquire);
            if (index < 0) {
                return Lease();
            }
            Entry& entry = entries_[static_cast<size_t>(index)];
            int32_t count = entry.readers.load(std::memory_order_relaxed);
            while (count != kWriting) {
                if (entry.readers.compare_exchange_weak(count, count + 1, std::memory_order_acquire)) {
                    Lease lease(&entry);
                    // The writer may have reused the entry before it was leased. Then a newer one exists, and
                    // this one may have only its early publication.
                    if (which.load(std::memory_order_acquire) == index) {
                        return lease;
                    }
                    break;
                }
            }
        }
    }

    static constexpr int32_t kWriting = -1;
    std::vector<Entry> entries_;
    std::atomic<int32_t> newest_{-1}, early_{-1};
    int32_t writing_ = -1;
};

} // namespace fathom
