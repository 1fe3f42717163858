// SPDX-License-Identifier: Apache-2.0
// A pilot's session: a live run, and the window on the main thread.
#pragma once

#include "apps/operate/last_seconds.h"
#include "apps/operate/live_run.h"
#include "apps/operate/recorder_control.h"
#include "apps/operate/run_display.h"
#include "apps/operate/tone_player.h"
#include "apps/output/fault_trace.h"

#include <cstdint>
#include <string>
#include <vector>

namespace fathom::operate {

// Receivers of a live run's records, from the first (`snapshots`) to the last (`recorder`).
struct LiveSinks {
    // arm: null = the tool moves freely.
    LiveSinks(const OperateOptions& options, double period, const ArmSetup* arm);

    RunObservers observers;
    Recorder recorder;
    LastSeconds last;
    PublishedSink published;
    FaultTrace faults;
    SnapshotSink snapshots;
};

// The run never waits for the window, which reads what the writer published. When the GPU is lost, the frame
// thread opens it again (DeviceHandover) while hand and keys keep working.
class OperatorRun {
public:
    // Throws BadInput (scene, display, device), Error, DeviceLost.
    OperatorRun(const OperateOptions& options, const GlobalOptions& global);

    // Runs until the window is closed, the time is up, a signal arrives or something fails. Throws the
    // failure.
    void run();

    // After run(): the recording that the pilot wants to see next; empty = none.
    std::string next() const;
    // After run(): the final state of the view.
    const RunView& view() const { return display_.view; }
    const RealtimeRun& engine() const { return live_.engine(); }

private:
    void changeScene(const Scene& scene, const std::vector<Shape>& shapes);
    void keepScene(uint64_t number); // the fixtures from this change on, for the last seconds
    void checkArming();              // switches forces off again if a check fails
    void obeyObservers();            // their requests
    bool forcesGone() const;
    void offWhenMinimised();
    void switchPilot();
    void mark(); // marks this moment if requested
    void frame();
    void show();        // shows the drawn frame if there is a device
    void reopen();      // opens the canvas on another device
    void handleInput(); // applies the keys and clicks of this frame
    void writeState(bool now);
    bool wantsToEnd() const;
    void report() const;

    OperateOptions options_;
    StopSignals signals_;
    ThreadPlacement placement_;
    Window window_;
    CpuConfinement confined_;
    Session session_;
    LiveSinks sinks_;
    RunDisplay display_;
    FixtureEditor editor_;
    RecorderControl recording_;
    ShownArm measured_;
    TonePlayer tones_;
    bool showsGone_ = false; // the window's title says that the GPU is gone
    struct {
        bool wereOn = false;       // after the last handleInput()
        bool offRequested = false; // since the last handleInput()
    } forces_;
    LiveRun live_; // last, so that its threads end before what they use
};

} // namespace fathom::operate
