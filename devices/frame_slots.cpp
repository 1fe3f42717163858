// SPDX-License-Identifier: Apache-2.0
#include "devices/frame_slots.h"

#include "engine/types/error.h"

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <new>
#include <unistd.h>

namespace fathom {

namespace {

std::shared_ptr<void> pages(size_t bytes) {
    const size_t padded = wholePages(bytes);
    void* block = std::aligned_alloc(wholePages(1), padded);
    if (block == nullptr) {
        throw std::bad_alloc();
    }
    std::memset(block, 0, padded); // also touches every page, so that no frame pays for the first fault
    return {block, std::free};
}

} // namespace

size_t wholePages(size_t bytes) {
    const size_t page = static_cast<size_t>(::sysconf(_SC_PAGESIZE));
    return std::max(page, (bytes + page - 1) / page * page);
}

FrameSlot::FrameSlot(uint32_t pixels, bool colour)
    : pixels_(pixels)
    , depth_(pages(size_t{pixels} * sizeof(uint16_t)))
    , colour_(colour ? pages(size_t{pixels} * sizeof(uint32_t)) : nullptr) {}

FrameSlots::FrameSlots(uint32_t pixels, bool colour, uint32_t count) {
    for (uint32_t i = 0; i < count; ++i) {
        slots_.push_back(std::make_unique<FrameSlot>(pixels, colour));
    }
}

FrameSlot* FrameSlots::acquire() noexcept {
    for (size_t i = 0; i < slots_.size(); ++i) {
        FrameSlot& slot = *slots_[next_];
        next_ = (next_ + 1) % slots_.size();
        if (!slot.taken_.exchange(true, std::memory_order_acquire)) {
            return &slot;
        }
    }
    return nullptr;
}

FrameSlot& FrameSlots::acquireFor(const std::string& camera) {
    FrameSlot* slot = acquire();
    if (slot == nullptr) {
        throw Error(camera + ": all frame buffers are leased");
    }
    return *slot;
}

size_t FrameSlots::inFlight() const noexcept {
    return static_cast<size_t>(std::ranges::count_if(
        slots_, [](const auto& slot) { return slot->taken_.load(std::memory_order_relaxed); }));
}

} // namespace fathom
