// SPDX-License-Identifier: Apache-2.0
#include "tests/haptics/allocation_count.h"

#include <atomic>
#include <cstddef>
#include <cstdlib>
#include <new>
#include <utility>

namespace {
std::atomic<uint64_t> allocations{0};
thread_local uint64_t threadAllocations = 0;
thread_local bool nextFails = false;

void* counted(std::size_t size, std::size_t alignment) {
    allocations.fetch_add(1, std::memory_order_relaxed);
    ++threadAllocations;
    const std::size_t whole = (size + alignment - 1) / alignment * alignment;
    void* memory = std::aligned_alloc(alignment, whole == 0 ? alignment : whole);
    if (memory == nullptr || std::exchange(nextFails, false)) {
        std::free(memory);
        throw std::bad_alloc();
    }
    return memory;
}
} // namespace

namespace fathom {
uint64_t allocationCount() noexcept {
    return allocations.load(std::memory_order_relaxed);
}
uint64_t threadAllocationCount() noexcept {
    return threadAllocations;
}
void failNextAllocation() noexcept {
    nextFails = true;
}
} // namespace fathom

// Not inlined, or the compiler warns because it sees memory from `new` passed to free().
[[gnu::noinline]] void* operator new(std::size_t size) {
    return counted(size, alignof(std::max_align_t));
}
void* operator new(std::size_t size, std::align_val_t alignment) {
    return counted(size, static_cast<std::size_t>(alignment));
}
void* operator new(std::size_t size, const std::nothrow_t&) noexcept {
    return std::malloc(size == 0 ? 1 : size);
}
[[gnu::noinline]] void operator delete(void* memory) noexcept {
    std::free(memory);
}
[[gnu::noinline]] void operator delete(void* memory, std::size_t) noexcept {
    std::free(memory);
}
[[gnu::noinline]] void operator delete(void* memory, std::align_val_t) noexcept {
    std::free(memory);
}
[[gnu::noinline]] void operator delete(void* memory, std::size_t, std::align_val_t) noexcept {
    std::free(memory);
}
