// SPDX-License-Identifier: Apache-2.0
// The frame cadence in real time: paces the source, has each picture turned into a fixture set, tells the
// haptic cadence.
#pragma once

#include "apps/binding/crossings.h"
#include "apps/binding/run_clock.h"
#include "engine/cycle/cadence_trace.h"

#include <deque>
#include <memory>
#include <optional>

namespace fathom {

// What the loop needs of a camera and the passes behind it. One thread.
class FrameFeed {
public:
    virtual ~FrameFeed() = default;
    // Gets the next picture ready; its index, or nothing when the source has ended. Throws DeviceLost when
    // the camera is gone (it is asked again later), Error otherwise.
    virtual std::optional<uint32_t> fetch() = 0;
    // When that picture was taken, of a source whose pictures come by themselves (a live camera): it is
    // waited for in fetch(), and paced by nobody. Nothing: the loop paces the source.
    virtual std::optional<RunClock::Time> captured() const { return std::nullopt; }
    // Where the arm was when the picture was taken, as near as is known, before publish(); the pose is not
    // given. Not called without an arm or before the first turn.
    virtual void shown(const ToolState&) {}
    // That picture, captured at t [s], becomes the newest fixture set. Fills everything in `out` but its t. A
    // picture that is the same again makes no set: `changed` false, the set and the colour in `out` are left
    // alone.
    virtual void publish(double t, PublishedFrame& out) = 0;
    // Whether the device under publish() can be made anew when that threw DeviceFailed; else
    // these end the run.
    virtual bool renewable() const { return false; }
    // It is lost, as is known before any picture went to it: it is made anew while the camera is gone, too.
    virtual bool lost() const { return false; }
    // Makes it anew. Throws the same while it is not there (asked again later), and when `stop` is set while
    // it waits for somebody.
    virtual void renew(const std::atomic<bool>& /*stop*/) {}
};

// The source's pictures come at period x (index - first index), by the clock: a picture counts as captured
// when its turn comes; one of a live source when it was taken. When one takes so long that a live camera
// would have thrown pictures away meanwhile, these are counted as lost and the source plays on from there: no
// recorded picture is left out.
class FrameLoop {
public:
    FrameLoop(FrameFeed& feed, Crossings& crossings, const RunClock& clock, double period,
              CadenceTrace* trace);

    // Before the clock starts: the first picture, at t = 0. False when the source has none.
    bool first();
    // Until the source ends or `stop`. Throws what the feed throws, but retries when the camera is gone.
    void run(const std::atomic<bool>& stop);

    uint64_t lost() const { return lost_; } // after run()
    const SceneUpdate& news() const { return news_; }

private:
    std::optional<uint32_t> fetch(const std::atomic<bool>& stop);
    void publish(double t);
    void publishOrRenew(double t, const std::atomic<bool>& stop);
    void renew(const std::atomic<bool>& stop);
    void tell();
    PublishedFrame* emptyFrame();
    void countLost(double due);

    FrameFeed& feed_;
    Crossings& crossings_;
    const RunClock& clock_;
    double period_;
    CadenceTrace* trace_;
    std::deque<std::unique_ptr<PublishedFrame>> owned_; // all there are, wherever they are now
    PublishedFrame* spare_ = nullptr;                   // one whose picture came to nothing
    double retry_;                                      // [s] until a lost device is asked for again
    SceneUpdate news_;
    bool cameraGone_ = false, deviceGone_ = false;
    uint32_t firstIndex_ = 0;
    double origin_ = 0.0; // [s] when the first picture would have been due
    bool ended_ = false;
    uint64_t lost_ = 0;
};

} // namespace fathom
