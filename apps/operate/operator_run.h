// SPDX-License-Identifier: Apache-2.0
// A pilot's session: the threads of a realtime run, and the window on the main thread.
#pragma once

#include "apps/binding/stop_signals.h"
#include "apps/binding/view_publisher.h"
#include "apps/operate/canvas.h"
#include "apps/operate/operate_command.h"
#include "apps/operate/pilot_hand.h"
#include "apps/operate/recorder.h"
#include "apps/operate/run_thread.h"
#include "apps/operate/screen.h"
#include "apps/operate/state_log.h"
#include "apps/operate/steering.h"
#include "apps/operate/traces_panel.h"
#include "apps/replay/fault_trace.h"
#include "apps/session/path_hand.h"
#include "apps/session/session_feed.h"
#include "engine/run/realtime_run.h"

#include <memory>

namespace fathom::operate {

// The run never waits for the window: it has the same haptic, contact, camera and writer threads as `replay
// --realtime`, and the window reads what the writer published. When the GPU is lost, the camera thread opens
// it again (DeviceHandover) while hand and keys keep working.
class OperatorRun {
public:
    // Throws BadInput (scene, display, device), Error, DeviceLost.
    OperatorRun(const OperateOptions& options, const GlobalOptions& global);

    // Runs until the window is closed, the time is up, a signal arrives or something fails. Throws the
    // failure.
    void run();

    // After run(): the final state of the view.
    const RunView& view() const { return view_; }
    const RealtimeRun& engine() const { return *engine_; }

private:
    static HapticOptions softly(const Scene& scene, const Tool& tool);
    HapticDevice& device(); // the device that drives the tool
    void makeHand(const Pose& start, const Pose* tool);
    void makeEngine(const Pose& start, const Pose* tool);
    void forgetFrames();
    void startThreads();
    void followPilot();
    void frame();
    void show();   // shows the drawn frame if there is a device
    void reopen(); // opens the canvas on another device
    void listen(); // applies the keys and clicks of this frame
    uint32_t buttonsOf(const Console& console) const;
    std::filesystem::path freshRecording();
    void startRecording();
    void followRecorder();
    void exportTraces();
    StateExtras extras() const;
    HudInput hudInput() const;
    bool wantsToEnd() const;
    void report() const;

    OperateOptions options_;
    StopSignals signals_;
    ThreadPlacement placement_;
    Window window_;
    CpuConfinement confined_;
    Session session_;
    HapticOptions haptics_;
    SessionFeed feed_;
    std::unique_ptr<ViewPublisher> observers_; // null = no view socket
    Recorder recorder_;
    PublishedSink published_;
    FaultTrace faults_;
    SnapshotSink sink_;
    std::unique_ptr<RealtimeRun> engine_;
    std::unique_ptr<HapticCycle> cycle_;
    std::unique_ptr<PilotHand> pilot_;
    std::unique_ptr<PathHand> path_;
    std::unique_ptr<GatedHand> hand_;
    std::unique_ptr<Steering> steering_;
    std::unique_ptr<FixtureEditor> editor_;

    Console console_;
    std::unique_ptr<Canvas> canvas_;
    RunView view_;
    MeasuredArm measured_;
    Screen screen_;
    TracesPanel traces_;
    Alarms alarms_;
    StateLog log_;
    bool toldGone_ = false, forcesOff_ = false; // forcesOff_: requested since the last listen()
    double started_ = 0.0, windowHz_ = 0.0, lastFrame_ = 0.0;
    uint32_t recordings_ = 0;           // number of the last folder name tried
    std::string recordingTo_;           // recording folder until all is on disk; empty = none
    std::unique_ptr<RunThread> thread_; // last member, so it ends before what it uses and sends a zero wrench
};

} // namespace fathom::operate
