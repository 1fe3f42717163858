// SPDX-License-Identifier: Apache-2.0
// The camera and passes of a session, as the frame thread calls them, with changes from the window.
#pragma once

#include "apps/session/session.h"
#include "engine/run/frame_loop.h"
#include "engine/types/colour_copy.h"

#include <functional>
#include <mutex>
#include <optional>

namespace fathom {

// The frame thread calls the functions of FrameFeed; any other thread may call the rest.
class SessionFeed : public FrameFeed {
public:
    // onShapes: called on the frame thread with the new shapes of a recorded edit; may be null.
    explicit SessionFeed(Session& session, std::function<void(const std::vector<Shape>&)> onShapes = nullptr);

    std::optional<uint32_t> fetch() override;
    std::optional<RunClock::Time> captured() const override;
    void armAtCapture(const ArmPosture& posture) override;
    void publish(double t, PublishedFrame& out) override;
    bool renewable() const override { return true; }
    bool lost() const override { return session_.handover && session_.handover->lost(); }
    void renew(const std::atomic<bool>& stop) override;

    // Call at the start of a run. If the device is lost at its first frame, the run starts with the previous
    // set.
    void begin() { begins_ = true; }
    // Takes effect from the next frame on. Frames with a PublishedFrame::edit of at least the returned number
    // use it. The classes of points must stay the same.
    uint64_t setScene(const Scene& scene);
    // While frozen, frames are captured and shown, but the active set stays the same for all fixtures.
    void freeze(bool frozen) { frozen_.store(frozen); }
    // True while passes run on the device. Threads that share its queue wait.
    bool busy() const { return busy_.load(std::memory_order_acquire); }

private:
    bool takeEdits(uint32_t index);
    FrameReport process();
    void publishNew(PublishedFrame& out);

    Session& session_;
    std::function<void(const std::vector<Shape>&)> onShapes_;
    std::optional<Frame> next_;
    double taken_ = 0.0; // [s] capture time of a live camera
    ColourCopy colours_;
    std::atomic<bool> busy_{false}, frozen_{false}, edited_{false};
    std::mutex sceneMutex_; // guards pending_ and requested_; the haptic thread never takes it
    Scene pending_;
    uint64_t requested_ = 0; // number of the newest requested change
    uint64_t applied_ = 0;   // number of the newest change that frames use
    bool published_ = false, begins_ = false;
};

} // namespace fathom
