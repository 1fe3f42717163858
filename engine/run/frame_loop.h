// SPDX-License-Identifier: Apache-2.0
// The frame cadence in real time: paces the source, has a fixture set made from each frame and publishes
// scene updates.
#pragma once

#include "engine/cycle/cadence_trace.h"
#include "engine/run/channels.h"
#include "engine/run/run_clock.h"
#include "engine/types/retry_pause.h"

#include <deque>
#include <memory>
#include <optional>

namespace fathom {

// The camera and the passes as the loop uses them. Frame thread only.
class FrameFeed {
public:
    virtual ~FrameFeed() = default;
    // Fetches the next frame. Returns its index, or nothing when the source has ended. Throws DeviceLost when
    // the camera is lost (the loop retries later), Error otherwise.
    virtual std::optional<uint32_t> fetch() = 0;
    // Capture time of that frame if the source is live: then fetch() waited for it. Nothing: the loop paces
    // the source.
    virtual std::optional<RunClock::Time> captured() const { return std::nullopt; }
    // Sets the arm's posture nearest to the capture time, before publish(). Not called without an arm or
    // before the first step.
    virtual void armAtCapture(const ArmPosture&) {}
    // Makes the newest fixture set from that frame, captured at t [s]. Fills all of `out` except t. A
    // repeated frame makes no set: `changed` is false, and set and colour in `out` are unchanged.
    virtual void publish(double t, PublishedFrame& out) = 0;
    // Whether the device that publish() uses can be opened again after publish() threw DeviceFailed. If not,
    // such an error ends the run.
    virtual bool renewable() const { return false; }
    // Whether the device is lost, although no frame was given to it. The loop then opens it again even while
    // the camera is lost.
    virtual bool lost() const { return false; }
    // Opens the device again. Throws DeviceFailed while it is missing (the loop retries later), or when
    // `stop` is set while it waits for another thread.
    virtual void renew(const std::atomic<bool>& /*stop*/) {}
};

// Frame i of a recorded source is due at period x (i - first i) on the clock, which is its capture time. A
// live source has its own capture times. If a frame takes so long that a live camera would have dropped
// others, these count as lost and the schedule shifts, so that no recorded frame is skipped.
class FrameLoop {
public:
    FrameLoop(FrameFeed& feed, Channels& channels, const RunClock& clock, double period, CadenceTrace* trace);

    // Call before the clock starts: publishes the first frame, at t = 0. False when the source has none.
    bool first();
    // Runs until the source ends or `stop`. Passes on exceptions of the feed, but retries while the camera is
    // lost.
    void run(const std::atomic<bool>& stop);

    uint64_t lost() const { return lost_; } // after run()
    const SceneUpdate& update() const { return update_; }

private:
    std::optional<uint32_t> fetch(const std::atomic<bool>& stop);
    void publish(double t, const std::atomic<bool>& stop); // gives up at `stop`
    void publishOrRenew(double t, const std::atomic<bool>& stop);
    void renew(const std::atomic<bool>& stop);
    void publishUpdate();
    PublishedFrame* emptyFrame(const std::atomic<bool>& stop); // null: `stop`
    void countLost(double due);

    FrameFeed& feed_;
    Channels& channels_;
    const RunClock& clock_;
    double period_;
    CadenceTrace* trace_;
    std::deque<std::unique_ptr<PublishedFrame>> owned_; // all frames, wherever they are in use
    PublishedFrame* spare_ = nullptr;                   // unused because its frame failed
    RetryPause retry_;                                  // of a lost device
    SceneUpdate update_;
    bool cameraGone_ = false, deviceGone_ = false;
    uint32_t firstIndex_ = 0;
    double origin_ = 0.0; // [s] time when the first frame would have been due
    bool ended_ = false;
    uint64_t lost_ = 0;
};

} // namespace fathom
