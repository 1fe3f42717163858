// SPDX-License-Identifier: Apache-2.0
// The threads of a pilot's run and the objects that they use. Another pilot gets a new run on the same
// session.
#pragma once

#include "apps/binding/stop_signals.h"
#include "apps/operate/device_panel.h"
#include "apps/operate/operate_command.h"
#include "apps/operate/pilot_hand.h"
#include "apps/operate/run_thread.h"
#include "apps/operate/steering.h"
#include "apps/session/path_hand.h"
#include "apps/session/session_feed.h"
#include "engine/run/realtime_run.h"

#include <memory>

namespace fathom::operate {

// Window thread. The same haptic, contact, camera and writer threads as `replay --realtime`; none waits for
// the window. Everything given to the constructor outlives this.
class LiveRun {
public:
    LiveRun(const OperateOptions& options, Session& session, const StopSignals& signals,
            const ThreadPlacement& placement, RunSink& sink, RunObserver& observers);

    // Starts the first run, with forces off. Throws BadInput, Error, DeviceLost.
    void start(const std::vector<Shape>& shapes);
    // Turns forces off and ends the run. False when it had ended by itself: then the window ends.
    bool pause();
    // Starts a run with the session's present pilot. tool: the step where the tool stays; null = at the start
    // of the path.
    void restart(const std::vector<Shape>& shapes, const StepRecord* tool);
    void end() { thread_->end(); }

    // Moves the hand by this frame's keys and mouse; returns where the large view was clicked.
    std::optional<ImVec2> steer(Console& console, const ViewPort& large, double toolDepth);
    // Passes on forces, frozen fixtures and buttons. Turns forces off if the window stood still for so long
    // that no pilot could have done it (GatedHand::kSilence).
    void apply(Console& console);
    // Takes the device's button that is pressed for Console::Editing::mapping, and saves the mapping.
    void mapButtons(Console& console);
    HandDeviceFacts device() const;
    void forcesOff() { hand_->setForces(false); }
    void setShapes(const std::vector<Shape>& shapes);
    // Warns of shapes of the scene that push the tool or arm at the start. After start() and restart().
    void warnOfStart(const Scene& scene) const;

    bool ended() const { return thread_->ended(); }
    std::exception_ptr failure() const { return thread_->failure(); }
    const HapticOptions& haptics() const { return haptics_; }
    SessionFeed& feed() { return feed_; }
    bool handPresent() const { return hand_->present(); }
    const RealtimeRun& engine() const { return *engine_; }

private:
    HapticDevice& driver(); // the device that drives the tool
    void makeHand(const std::vector<Shape>& shapes, const Pose& start, const Pose* tool);
    void makeEngine(const std::vector<Shape>& shapes, const Pose& start, const Pose* tool);
    void awaitFrame();
    void forgetFrames();
    uint32_t buttonsOf(const Console& console) const;

    const OperateOptions& options_;
    Session& session_;
    const StopSignals& signals_;
    const ThreadPlacement& placement_;
    RunSink& sink_;
    RunObserver& observers_;
    HapticOptions haptics_;
    ButtonMap buttons_;
    bool mappedStillDown_ = false; // a button that was mapped is still down
    SessionFeed feed_;
    std::unique_ptr<RealtimeRun> engine_;
    std::unique_ptr<HapticCycle> cycle_;
    ToolPlace start_; // of the run, because the haptic thread moves cycle_
    std::unique_ptr<PilotHand> pilot_;
    std::unique_ptr<PathHand> path_;
    std::unique_ptr<GatedHand> hand_;
    std::unique_ptr<Steering> steering_;
    std::unique_ptr<RunThread> thread_; // last, so it ends before what it uses and sends a zero wrench
};

} // namespace fathom::operate
