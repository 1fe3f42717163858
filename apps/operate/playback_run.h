// SPDX-License-Identifier: Apache-2.0
// The window on a recording: shows any moment of it, with the frame, the hand and the forces of that time.
#pragma once

#include "apps/binding/stop_signals.h"
#include "apps/operate/image_export.h"
#include "apps/operate/operate_command.h"
#include "apps/operate/past_scene.h"
#include "apps/operate/recorder.h"
#include "apps/operate/run_display.h"
#include "apps/operate/steering.h"
#include "apps/operate/time_line_panel.h"
#include "engine/types/retry_pause.h"

namespace fathom::operate {

// Processes the frames again with the fixtures in the panel; hand, tool and wrench come from the files.
// Without wrench.csv it shows the hand through the hand map, and no tool. One thread. Opens a lost GPU again
// and keeps the shown moment.
class PlaybackRun {
public:
    // options.recording names the folder. Throws BadInput, Error, DeviceLost.
    PlaybackRun(const OperateOptions& options, const GlobalOptions& global);

    // Runs until the window is closed, the time is up or a signal arrives.
    void run();
    // After run(): the recording to see next, or kLiveRun; empty = none.
    std::string next() const;

private:
    bool wantsToEnd() const;
    void frame(double dt);
    void draw(double dt);
    void loseDevice(const std::string& why);
    void lookForDevice(); // retries from time to time while there is no device
    void handleInput();
    void mark(); // marks the shown moment if requested
    void followTime(double dt);
    void exportImage(); // of the drawn frame
    void showMoment();
    uint32_t buttonsAt(double t) const;

    OperateOptions options_;
    StopSignals signals_;
    Window window_;
    Session session_;
    HapticOptions haptics_;
    std::optional<HandPath> hand_;
    TickLog log_;
    PastScene past_;
    Recorder unusedRecorder_; // never started: ends the chain of sinks
    SnapshotSink sink_;
    RunDisplay display_;
    FixtureEditor editor_;
    Steering steering_;
    TimeLinePanel panel_;
    ImageExport export_;
    double retryAt_ = 0.0; // [s] time of the next attempt to open a device
    RetryPause retry_;
    double shown_ = -1.0; // [s] shown moment of the recording
};

} // namespace fathom::operate
