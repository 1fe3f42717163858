// SPDX-License-Identifier: Apache-2.0
// `replay --realtime`: runs the session's cycles on their threads against the wall clock. The calling thread
// writes the files and audits.
#pragma once

#include "apps/binding/stop_signals.h"
#include "apps/binding/watched_hand.h"
#include "apps/output/fault_trace.h"
#include "apps/output/progress.h"
#include "apps/replay/percentiles.h"
#include "apps/replay/replay_parts.h"
#include "apps/session/session_feed.h"
#include "engine/run/realtime_run.h"

#include <memory>
#include <optional>

namespace fathom {

// Figures that only a realtime run has.
struct RealtimeFigures {
    Percentiles wokenLateMicros; // [us] delay of wake-ups after their due time, without the step itself
    Percentiles exposureMs;      // [ms] live camera: start of exposure to published set
    bool live = false;           // the camera is live
    uint64_t framesLost = 0;     // frames that a live camera dropped, or would have dropped
    uint64_t periodsMissed = 0;  // periods without a tick
    uint64_t framesInPlace = 0;  // frames whose depth the device read without a copy
    uint64_t staleTicks = 0;     // ticks whose scene was so old that forces fade
    uint64_t recordsLost = 0;    // records lost because the writer was too slow
    uint32_t renewals = 0;       // times a lost device was opened again
    bool stopped = false;        // ended by a signal
};

// Times are on the run's clock: t = 0 when the first frame is processed and the path is open. Frame j is
// captured at (index j - index 0) / 30 s (ReplayOptions::frameRate). The run ends when the frames (plus one
// such period) and the hand path have ended, or on a signal of StopSignals; all files are complete in both
// cases.
class RealtimeReplay final : private ReplayParts, private RunSink {
public:
    // Build the session on a thread confined to placement.rest, because the workers of a software device
    // inherit its CPUs. Renders the frames of a simulated camera in advance (SpooledCamera), so that the run
    // does not measure rendering; only the first one if no fixture selects points. trace may be null.
    RealtimeReplay(Session& session, const ReplayOptions& options, ReplayRecorder& recorder,
                   const ThreadPlacement& placement, CadenceTrace* trace);
    ~RealtimeReplay() override;

    // Runs to the end; returns the results that only the run knows. Throws BadInput when no frame is usable.
    ReplayRecorder::Ending run();

    const RealtimeFigures& figures() const { return figures_; }
    // Rethrows the failure that ended the run early, if any. Call it after the files are written.
    void rethrowFailure() const;

private:
    class Feed;

    void frame(const PublishedFrame& frame, const HostFixtures& set) override;
    void query(const QueryNote& note) override;
    void step(const TickRow& row, const ObeyedSet& obeyed) override;
    void audit(const TickRow& row, const ObeyedSet& obeyed);
    void takeShapes(const std::vector<Shape>& shapes);
    RealtimeOptions runOptions(CadenceTrace* trace);
    void spool();
    void runLive(const HandPath& path);
    ReplayRecorder::Ending ending();

    ThreadPlacement placement_;
    StopSignals signals_;
    Progress progress_;
    bool audited_ = true; // every step so far was audited
    FaultTrace faults_;   // receives every tick first
    RunObservers observers_;
    std::unique_ptr<Feed> feed_;
    std::unique_ptr<RealtimeRun> run_;
    std::optional<WatchedHand> watched_; // only with a live hand
    std::vector<float> wokenLateMicros_;
    double lastTick_ = 0.0; // [s]
    RealtimeFigures figures_;
};

} // namespace fathom
