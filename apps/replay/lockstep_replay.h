// SPDX-License-Identifier: Apache-2.0
// Lockstep: all cadences on one thread, on the run's own clock. haptics.csv has no measured times in it.
#pragma once

#include "apps/replay/replay_command.h"
#include "apps/replay/replay_recorder.h"
#include "apps/replay/tool_audit.h"
#include "apps/session/session.h"
#include "engine/cycle/cadence_trace.h"
#include "engine/run/active_contacts.h"
#include "engine/run/scene_update.h"

#include <deque>
#include <memory>
#include <optional>

namespace fathom {

// Tick i is at i / rate_hz. Frame j is at j / 30 s whatever its stamp, and active from the first tick at or
// after that. Each step is preceded by one contact query at its start pose, whose answer is offered
// contact.delay ticks later. The run ends when the frames (plus 1/30 s) and the hand path have ended.
class LockstepReplay {
public:
    // trace: null = none.
    LockstepReplay(Session& session, const ReplayOptions& options, ReplayRecorder& recorder,
                   CadenceTrace* trace = nullptr);

    // Runs to the end and hands over what only the loop knows.
    ReplayRecorder::Ending run();

    static constexpr double kFramePeriod = 1.0 / 30.0; // [s]

private:
    // A published set, kept for the audit while a contact set may come from it.
    struct Kept {
        Fixtures fixtures;
        RegionGrid grid;
    };

    void fetch();       // the next usable frame from the camera, stamped with its lockstep time
    void processNext(); // through the frame cycle
    void takeEdit(uint32_t image);
    void takeDueFrames(double t);
    bool ended(double t) const;
    void query();
    void tick(double t);
    void audit(const StepRecord& record, const ToolState& start);
    const Kept* keptSet(uint64_t generation) const;
    void dropOldSets();

    Session& session_;
    const ReplayOptions& options_;
    ReplayRecorder& recorder_;
    CadenceTrace* trace_;
    std::vector<Shape> shapes_;
    HapticOptions haptics_;
    std::optional<HandPath> path_;
    std::unique_ptr<HapticDevice> hand_;
    std::optional<HapticCycle> cycle_;
    ToolAudit audit_;

    std::optional<Frame> next_;        // fetched, not yet due
    ArmPosture taken_;                 // of the arm, when next_ was fetched
    std::optional<FrameReport> ready_; // processed, not yet due
    double nextTime_ = 0.0;            // [s] of next_ or ready_
    double pathStart_ = 0.0;           // [s]
    bool published_ = false;           // some set is active
    std::vector<uint32_t> lastColour_;

    std::deque<std::unique_ptr<Kept>> kept_;
    std::deque<std::unique_ptr<ContactSet>> answers_; // asked, not yet due; oldest first
    ActiveContacts<std::unique_ptr<ContactSet>> contacts_;
    SceneUpdate scene_; // of the newest frame that is due
    uint64_t ticks_ = 0, framesDone_ = 0;
};

} // namespace fathom
