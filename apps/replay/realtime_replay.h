// SPDX-License-Identifier: Apache-2.0
// `replay --realtime`: the session's cycles on threads, by the wall clock; the caller's thread writes and
// audits.
#pragma once

#include "apps/binding/stop_signals.h"
#include "apps/binding/view_publisher.h"
#include "apps/binding/watched_hand.h"
#include "apps/replay/fault_trace.h"
#include "apps/replay/percentiles.h"
#include "apps/replay/progress.h"
#include "apps/replay/replay_command.h"
#include "apps/replay/replay_recorder.h"
#include "apps/replay/tool_audit.h"
#include "apps/session/session_feed.h"
#include "engine/run/realtime_run.h"

#include <memory>
#include <optional>
#include <string>

namespace fathom {

// Figures that only a real-time run has.
struct RealtimeFigures {
    Percentiles wokenLateMicros; // [us] wake-ups after they were due, compute time apart
    Percentiles exposureMs;      // [ms] live camera: from start of exposure to the published set
    bool live = false;           // the camera is
    uint64_t framesLost = 0;     // by a live camera, or that one would have thrown away
    uint64_t periodsMissed = 0;  // without a step
    uint64_t framesInPlace = 0;  // whose depth the device read in place
    uint64_t staleTicks = 0;     // with a scene old enough for forces to fade
    uint64_t recordsLost = 0;    // because the writer was too slow
    uint32_t renewals = 0;       // times that a lost device was opened again
    bool stopped = false;        // by a signal
};

// Times are of the run's clock: t = 0 when the first frame has been processed and the path opened; frame j is
// captured at (index j - index 0) / 30 s by the clock (ReplayOptions::frameRate). Ends when frames (plus
// one such period) and hand path both have, or on a signal of StopSignals: then every file is complete, too.
class RealtimeReplay final : private RunSink {
public:
    // The session must have been built on a thread confined to placement.rest, because the workers of a
    // software device inherit it. Renders the frames of a simulated camera in advance (SpooledCamera), so
    // that a run does not measure rendering. trace may be null.
    RealtimeReplay(Session& session, const ReplayOptions& options, ReplayRecorder& recorder,
                   const ThreadPlacement& placement, CadenceTrace* trace);
    ~RealtimeReplay() override;

    // Runs to the end and hands over what only the run knows. Throws BadInput when no frame is usable.
    ReplayRecorder::Ending run();

    const RealtimeFigures& figures() const { return figures_; }
    // Throws what ended the run early, if anything did: after the files are written.
    void rethrowFailure() const;

private:
    class Feed;

    void frame(const PublishedFrame& frame, const Fixtures& set) override;
    void query(const QueryNote& note) override;
    void step(const TickRow& row, const PublishedFrame* obeyed, bool obeyedKnown,
              std::span<const uint32_t> behind) override;
    void audit(const TickRow& row, const PublishedFrame* obeyed, bool obeyedKnown,
               std::span<const uint32_t> behind);
    void takeShapes(const std::vector<Shape>& shapes);
    RealtimeOptions runOptions(CadenceTrace* trace);
    void spool();
    void runLive(const HandPath& path);
    ReplayRecorder::Ending ending();

    Session& session_;
    const ReplayOptions& options_;
    ReplayRecorder& recorder_;
    ThreadPlacement placement_;
    StopSignals signals_;
    Progress progress_;
    std::vector<Shape> shapes_;
    HapticOptions haptics_;
    ToolAudit audit_;
    bool audited_ = true;                 // every step so far was audited
    FaultTrace faults_;                   // before this as a sink
    std::unique_ptr<ViewPublisher> view_; // null = no observers
    std::unique_ptr<Feed> feed_;
    std::unique_ptr<RealtimeRun> run_;
    std::optional<HapticCycle> cycle_;
    std::optional<WatchedHand> watched_; // of a live hand
    std::vector<float> wokenLateMicros_;
    RealtimeFigures figures_;
};

} // namespace fathom
