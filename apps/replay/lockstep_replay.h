// SPDX-License-Identifier: Apache-2.0
// Lockstep replay: all threads of a realtime run become steps on one thread with a simulated clock, so
// haptics.csv contains no measured times.
#pragma once

#include "apps/replay/replay_parts.h"
#include "engine/cycle/cadence_trace.h"
#include "engine/run/clearance.h"
#include "engine/run/delayed_contacts.h"
#include "engine/run/scene_update.h"

#include <atomic>
#include <deque>
#include <memory>
#include <optional>

namespace fathom {

// Tick i is at i / rate_hz. Frame j is at j / 30 s regardless of its time stamp, and is active from the first
// tick at or after that. Before each step, one contact query runs at the step's start pose; its answer
// arrives contact.delay ticks later. The run ends when both the frames (plus 1/30 s) and the hand path have
// ended.
class LockstepReplay final : private ReplayParts {
public:
    // stop: ends the run early, with a warning. trace: records when each cadence runs; null = no trace.
    LockstepReplay(Session& session, const ReplayOptions& options, ReplayRecorder& recorder,
                   const std::atomic<bool>& stop, CadenceTrace* trace = nullptr);

    // Runs to the end, or for at least one tick; returns the results that only the loop knows.
    ReplayRecorder::Ending run();

private:
    // A published set. Retained for the audit as long as a contact set may refer to it.
    struct RetainedSet {
        HostFixtures fixtures;
        RegionGrid grid;
    };

    void fetch();       // gets the next usable frame and stamps it with its lockstep time
    void notePeriod();  // of next_, before it has its lockstep time
    void warnOfRate();  // logs that a recording has another rate than lockstep; call at the end
    void processNext(); // runs the frame cycle on next_
    void takeEdit(uint32_t image);
    void takeDueFrames(double t);
    bool ended(double t) const;
    void play(); // all ticks
    double expectedEnd(uint64_t frames) const;
    void query();
    void tick(double t);
    void audit(const TickRow& row);
    const RetainedSet* retainedSet(uint64_t generation) const;
    void dropOldSets();

    const std::atomic<bool>& stop_;
    CadenceTrace* trace_;
    std::optional<HandPath> path_;
    std::unique_ptr<HapticDevice> hand_;
    SteppedClearance clearance_;

    std::optional<Frame> next_;        // fetched, not yet due
    std::vector<double> periods_;      // [s] per frame of a recording, by its stamps
    double lastStamp_ = 0.0;           // [s] of next_, as recorded
    uint32_t lastIndex_ = 0;           // of next_
    ArmPosture taken_;                 // arm posture when next_ was fetched
    std::optional<FrameReport> ready_; // processed, not yet due
    double nextTime_ = 0.0;            // [s] time of next_ or ready_
    double pathStart_ = 0.0;           // [s]
    bool published_ = false;           // a set is active
    std::vector<uint32_t> lastColour_;

    std::deque<std::unique_ptr<RetainedSet>> retained_;
    DelayedContacts contacts_;
    SceneUpdate scene_; // from the newest frame that is due
    uint64_t ticks_ = 0, framesDone_ = 0;
};

} // namespace fathom
