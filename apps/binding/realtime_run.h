// SPDX-License-Identifier: Apache-2.0
// A run in real time: camera, contact and haptic threads over their crossings, the caller's thread as the
// writer. Knows no Vulkan: what the threads do is behind FrameFeed, ContactAnswers, HapticCycle and
// HapticDevice.
#pragma once

#include "apps/binding/contact_loop.h"
#include "apps/binding/frame_loop.h"
#include "apps/binding/haptic_loop.h"
#include "apps/binding/record_drain.h"
#include "apps/binding/thread_placement.h"

#include <exception>
#include <functional>
#include <mutex>
#include <optional>

namespace fathom {

struct RealtimeOptions {
    ThreadPlacement placement;
    double hapticPeriod = 0.001;     // [s]
    double framePeriod = 1.0 / 30.0; // [s]
    double staleAfter = 0.1;         // [s] scene age that is worth a warning
    CadenceTrace* trace = nullptr;
    ArmLink* arm = nullptr; // a real arm that follows; must outlive the run
    std::function<void(double t, uint64_t frames, uint64_t ticks)>
        progress; // on the writer thread, now and then
};

class RealtimeRun {
public:
    // contacts null: the scene has nothing to collide with and gets no contact thread.
    RealtimeRun(FrameFeed& frames, ContactAnswers* contacts, const RealtimeOptions& options);

    // The first picture through the passes, on this thread, before the clock starts. False when the source
    // has none.
    bool firstFrame() { return frames_.first(); }

    // Runs until frames and path have ended, `stop` is set or something fails; then the hand has zero force,
    // all threads have ended and the sink has every record. What a thread threw is in failure(). An exception
    // of the sink passes through, after the same end.
    void run(HapticCycle& cycle, HapticDevice& hand, double pathDuration, RunSink& sink,
             const std::atomic<bool>& stop);

    // Any one thread: other authored shapes, obeyed from the next turn on.
    void setShapes(std::span<const Shape> shapes);

    uint64_t framesLost() const { return frames_.lost(); }
    uint64_t periodsMissed() const { return missed_; }
    uint64_t staleTicks() const { return staleTicks_; } // with a scene older than staleAfter
    uint64_t recordsLost() const { return crossings_.ticks.dropped() + crossings_.queries.dropped(); }
    const PublishedFrame* lastFrame() const { return last_; } // lives as long as this
    // What a thread threw; null when none did.
    std::exception_ptr failure() const { return failure_; }

private:
    void guarded(const std::function<void()>& body) noexcept;
    void write(RecordDrain& drain, const std::atomic<bool>& stop);

    RealtimeOptions options_;
    RunClock clock_;
    Crossings crossings_;
    FrameLoop frames_;
    std::optional<ContactLoop> contact_;
    std::atomic<bool> stop_{false};
    std::mutex failureMutex_; // never taken by the haptic thread
    std::exception_ptr failure_;
    uint64_t missed_ = 0, staleTicks_ = 0;
    const PublishedFrame* last_ = nullptr;
};

} // namespace fathom
