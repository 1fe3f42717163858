// SPDX-License-Identifier: Apache-2.0
// The frame cadence in real time: paces the source, has each frame turned into a fixture set and publishes a
// scene update.
#pragma once

#include "engine/cycle/cadence_trace.h"
#include "engine/run/channels.h"
#include "engine/run/run_clock.h"

#include <deque>
#include <memory>
#include <optional>

namespace fathom {

// What the loop needs of a camera and the passes behind it. Frame thread only.
class FrameFeed {
public:
    virtual ~FrameFeed() = default;
    // Gets the next frame ready. Returns its index, or nothing when the source has ended. Throws DeviceLost
    // when the camera is gone (the loop asks again later), Error otherwise.
    virtual std::optional<uint32_t> fetch() = 0;
    // When a live source took that frame: fetch() waited for it and the loop does not pace it. Nothing: the
    // loop paces the source.
    virtual std::optional<RunClock::Time> captured() const { return std::nullopt; }
    // The posture of the arm nearest to the capture time, before publish(); the pose is not set. Not called
    // without an arm or before the first step.
    virtual void armAtCapture(const ToolState&) {}
    // Makes that frame, captured at t [s], the newest fixture set. Fills everything in `out` but its t. A
    // repeated frame makes no set: `changed` is false, the set and the colour in `out` are left alone.
    virtual void publish(double t, PublishedFrame& out) = 0;
    // Whether the device that publish() uses can be opened again after publish() threw DeviceFailed. If not,
    // such an error ends the run.
    virtual bool renewable() const { return false; }
    // The device is known to be lost before any frame was given to it: it is opened again even while the
    // camera is gone.
    virtual bool lost() const { return false; }
    // Opens the device again. Throws DeviceFailed while it is missing (the loop retries later), or when
    // `stop` is set while it waits for another thread.
    virtual void renew(const std::atomic<bool>& /*stop*/) {}
};

// The loop shows frame i of a source at period x (i - first i) on the clock, and that is its capture time; a
// live source has its own capture times. When one frame takes so long that a live camera would have dropped
// others, these are counted as lost and the source continues from there: no recorded frame is skipped.
class FrameLoop {
public:
    FrameLoop(FrameFeed& feed, Channels& channels, const RunClock& clock, double period, CadenceTrace* trace);

    // Before the clock starts: publishes the first frame, at t = 0. False when the source has none.
    bool first();
    // Until the source ends or `stop`. Throws what the feed throws, but retries while the camera is gone.
    void run(const std::atomic<bool>& stop);

    uint64_t lost() const { return lost_; } // after run()
    const SceneUpdate& update() const { return update_; }

private:
    std::optional<uint32_t> fetch(const std::atomic<bool>& stop);
    void publish(double t);
    void publishOrRenew(double t, const std::atomic<bool>& stop);
    void renew(const std::atomic<bool>& stop);
    void publishUpdate();
    PublishedFrame* emptyFrame();
    void countLost(double due);

    FrameFeed& feed_;
    Channels& channels_;
    const RunClock& clock_;
    double period_;
    CadenceTrace* trace_;
    std::deque<std::unique_ptr<PublishedFrame>> owned_; // all of them, wherever they are now
    PublishedFrame* spare_ = nullptr;                   // one whose frame failed
    double retry_;                                      // [s] until the next try to open a lost device
    SceneUpdate update_;
    bool cameraGone_ = false, deviceGone_ = false;
    uint32_t firstIndex_ = 0;
    double origin_ = 0.0; // [s] when the first frame would have been due
    bool ended_ = false;
    uint64_t lost_ = 0;
};

} // namespace fathom
