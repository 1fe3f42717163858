// SPDX-License-Identifier: Apache-2.0
// Camera memory for frames in flight: page-aligned, page-padded slots that are released through an atomic
// flag.
#pragma once

#include "engine/types/frame.h"

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace fathom {

// One frame's memory. Depth and colour are separate blocks, each on its own pages, zero at first.
class FrameSlot {
public:
    // Throws std::bad_alloc. colour false: no colour block.
    FrameSlot(uint32_t pixels, bool colour);
    FrameSlot(const FrameSlot&) = delete;
    FrameSlot& operator=(const FrameSlot&) = delete;

    std::span<uint16_t> depth() noexcept { return {static_cast<uint16_t*>(depth_.get()), pixels_}; }
    std::span<uint32_t> colour() noexcept {
        return {static_cast<uint32_t*>(colour_.get()), colour_ ? pixels_ : 0u};
    }

    std::span<std::byte> colourBytes() noexcept { return std::as_writable_bytes(colour()); }

    // Returns the memory to its camera; any thread, wait-free.
    void release() noexcept { taken_.store(false, std::memory_order_release); }
    // A lease on this slot's memory; the slots must outlive it. When the content's depth and colour are in
    // this memory, the frame says so and a device may read them in place.
    Frame lend(Frame::Content content) {
        name(content);
        return Frame(content, [this] { release(); });
    }
    // The same for owners that release more than the slot.
    void name(Frame::Content& content) const noexcept {
        if (content.depth.data() == depth_.get()) {
            content.depthMemory = depth_;
        }
        if (static_cast<const void*>(content.colourBytes().data()) == colour_.get()) {
            content.colourMemory = colour_;
        }
    }

private:
    friend class FrameSlots;
    uint32_t pixels_;
    std::shared_ptr<void> depth_, colour_;
    std::atomic<bool> taken_{false};
};

// A fixed set of slots. One thread (the camera's) acquires; any thread releases. The addresses never change.
class FrameSlots {
public:
    FrameSlots(uint32_t pixels, bool colour, uint32_t count);

    // Takes the next free slot; nullptr when all are in flight. Never waits.
    FrameSlot* acquire() noexcept;
    // The same; throws Error that names the camera when all are in flight.
    FrameSlot& acquireFor(const std::string& camera);

    size_t size() const { return slots_.size(); }
    size_t inFlight() const noexcept; // slots taken now; for tests

private:
    std::vector<std::unique_ptr<FrameSlot>> slots_;
    size_t next_ = 0;
};

// Bytes rounded up to whole pages, at least one page.
size_t wholePages(size_t bytes);

} // namespace fathom
