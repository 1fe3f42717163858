// SPDX-License-Identifier: Apache-2.0
// The mailbox behind a CameraPort: the camera thread puts in frames, the frame thread takes the newest.
#pragma once

#include "engine/front/core.h"
#include "engine/types/frame.h"

#include <array>
#include <atomic>
#include <condition_variable>
#include <mutex>
#include <optional>
#include <vector>

namespace fathom::v0 {

struct CameraPort::Impl {
    explicit Impl(front::CameraSetup made)
        : setup(std::move(made)) {}

    // Camera thread. Copies the frame if `release` is empty; otherwise borrows it if the formats allow. Calls
    // release() exactly once.
    SubmitStatus put(const Frame& frame, std::function<void()> release);

    // One thread. Copies the frame, whatever its stamp. Throws BadInput for a missing image or pose.
    fathom::Frame copy(const Frame& frame);

    // Frame thread. Waits for a frame until close(); nothing then.
    std::optional<fathom::Frame> take();
    // Any thread. Drops the waiting frame; take() returns nothing from now on.
    void close();

    const front::CameraSetup setup;
    const CameraModel& model = setup.model;
    const CameraInfo& info = setup.info;
    std::atomic<uint64_t> dropped{0}, processed{0};
    Nanoseconds last = 0; // camera thread: stamp of the newest frame; 0 = any stamp may follow

private:
    struct Copy { // memory for one copied frame
        std::vector<uint16_t> depth;
        std::vector<std::byte> colour;
        std::atomic<bool> used{false};
    };
    struct CopyRelease {
        void operator()(Copy* copy) const noexcept { copy->used.store(false, std::memory_order_release); }
    };
    using UsedCopy = std::unique_ptr<Copy, CopyRelease>;
    size_t depthAlignment() const noexcept {
        return model.depthFormat == DepthFormat::Metres ? sizeof(float) : sizeof(uint16_t);
    }
    size_t colourAlignment() const noexcept { return model.colourFormat == ColourFormat::Rgb ? 1 : 4; }
    SubmitStatus checkStamp(const Frame& frame) const noexcept;
    SubmitStatus checkImages(const Frame& frame) const noexcept;
    UsedCopy unused();
    void copyDepth(const Frame& frame, Copy& copy) const;
    void copyMetres(const Frame& frame, Copy& copy) const;
    std::span<const std::byte> colourOf(const Frame& frame) const;
    void copyColour(const Frame& frame, Copy& copy) const;
    fathom::Frame contentOf(const Frame& frame, std::function<void()> release);

    static constexpr size_t kCopies = 4; // one each: being filled, waiting, taken, being processed
    std::array<Copy, kCopies> copies_;
    uint32_t count_ = 0; // camera thread
    std::mutex mutex_;   // of all below
    std::condition_variable changed_;
    std::optional<fathom::Frame> waiting_;
    bool closed_ = false;
};

} // namespace fathom::v0
