// SPDX-License-Identifier: Apache-2.0
// A run in real time: frame, contact, clearance and haptic threads over their channels, the caller's thread
// as the writer. Knows no Vulkan: what the threads do is behind FrameFeed, ContactAnswers, HapticCycle and
// HapticDevice.
#pragma once

#include "engine/run/clearance.h"
#include "engine/run/contact_loop.h"
#include "engine/run/frame_loop.h"
#include "engine/run/haptic_loop.h"
#include "engine/run/record_drain.h"
#include "engine/run/thread_placement.h"
#include "engine/types/frame.h"

#include <exception>
#include <functional>
#include <mutex>
#include <optional>

namespace fathom {

struct RealtimeOptions {
    ThreadPlacement placement;
    double hapticPeriod = 0.001;               // [s]
    double framePeriod = kLockstepFramePeriod; // [s]
    bool warnWhenStale = true; // logs when forces begin and end to fade because the scene is old
    CadenceTrace* trace = nullptr;
    ArmLink* arm = nullptr; // a real arm that follows; must outlive the run
    // called on the writer thread, every few milliseconds
    std::function<void(double t, uint64_t frames)> progress;
};

class RealtimeRun {
public:
    // contacts: null if the scene has nothing to collide with; then there is no contact or clearance thread.
    RealtimeRun(FrameFeed& frames, ContactAnswers* contacts, const RealtimeOptions& options);

    // Processes the first frame on this thread, before the clock starts. False when the source has none.
    bool firstFrame() { return frames_.first(); }

    // Runs until frames and path have ended, `stop` is set or something fails. `stop` takes the force away at
    // once, also while the sink or `progress` is blocked. After the run the hand has zero force, all threads
    // have ended and the sink has every record. failure() is the exception of a thread. An exception of the
    // sink is passed on after the same shutdown.
    void run(HapticCycle& cycle, HapticDevice& hand, double pathDuration, RunSink& sink,
             const std::atomic<bool>& stop);

    // Any one thread: replaces the placed shapes from the next step on.
    void setShapes(std::span<const Shape> shapes);

    uint64_t framesLost() const { return frames_.lost(); }
    uint64_t periodsMissed() const { return missed_; }
    uint64_t staleTicks() const { return staleTicks_; } // steps with a scene older than kStaleAfter
    uint64_t recordsLost() const { return channels_.ticks.dropped() + channels_.queries.dropped(); }
    const PublishedFrame* lastFrame() const { return last_; } // lives as long as this
    // The exception of a thread; null if none failed.
    std::exception_ptr failure() const { return failure_; }

private:
    void guarded(const std::function<void()>& body) noexcept;
    void write(RecordDrain& drain, const std::atomic<bool>& stop);

    RealtimeOptions options_;
    RunClock clock_;
    Channels channels_;
    FrameLoop frames_;
    std::optional<ContactLoop> contact_;
    std::optional<ClearanceLoop> clearance_;
    std::atomic<bool> ending_{false};
    std::mutex failureMutex_; // never taken by the haptic thread
    std::exception_ptr failure_;
    uint64_t missed_ = 0, staleTicks_ = 0;
    const PublishedFrame* last_ = nullptr;
};

} // namespace fathom
