// SPDX-License-Identifier: Apache-2.0
// Camera and passes of a session as the frame thread of a run sees them, and what the window may change
// meanwhile.
#pragma once

#include "apps/session/session.h"
#include "engine/run/frame_loop.h"
#include "engine/types/colour_copy.h"

#include <functional>
#include <mutex>
#include <optional>

namespace fathom {

// The frame thread calls the FrameFeed functions; any other thread may call the rest.
class SessionFeed : public FrameFeed {
public:
    // onShapes: called on the frame thread with the shapes of a recorded edit, from its frame on; may be
    // null.
    explicit SessionFeed(Session& session, std::function<void(const std::vector<Shape>&)> onShapes = nullptr);

    std::optional<uint32_t> fetch() override;
    std::optional<RunClock::Time> captured() const override;
    void armAtCapture(const ToolState& place) override;
    void publish(double t, PublishedFrame& out) override;
    bool renewable() const override { return true; }
    bool lost() const override { return session_.handover && session_.handover->lost(); }
    void renew(const std::atomic<bool>& stop) override;

    // A run begins. If its first frame finds the device lost, the run starts on the set from before.
    void begin() { begins_ = true; }
    // Applies from the next frame on, whose PublishedFrame::edit is at least the number returned. The scene
    // keeps its classes of points.
    uint64_t setScene(const Scene& scene);
    // While frozen, frames are taken and shown but the active set stays, for all fixtures.
    void freeze(bool frozen) { frozen_.store(frozen); }
    // Passes are on the device: whoever shares its queue waits.
    bool busy() const { return busy_.load(std::memory_order_acquire); }

private:
    bool takeEdits(uint32_t index);
    FrameReport process();
    void publishNew(PublishedFrame& out);

    Session& session_;
    std::function<void(const std::vector<Shape>&)> onShapes_;
    std::optional<Frame> next_;
    double taken_ = 0.0; // [s] on a live camera's clock
    ColourCopy colours_;
    std::atomic<bool> busy_{false}, frozen_{false}, edited_{false};
    std::mutex sceneMutex_; // guards pending_ and requested_; the haptic thread never takes it
    Scene pending_;
    uint64_t requested_ = 0; // number of the newest change
    uint64_t applied_ = 0;   // number of the newest change that frames obey
    bool published_ = false, begins_ = false;
};

} // namespace fathom
