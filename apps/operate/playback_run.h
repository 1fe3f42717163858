// SPDX-License-Identifier: Apache-2.0
// The window on a recording: any moment of it, by a time line, with what was seen, done and felt then.
#pragma once

#include "apps/binding/stop_signals.h"
#include "apps/operate/canvas.h"
#include "apps/operate/operate_command.h"
#include "apps/operate/past_scene.h"
#include "apps/operate/recorder.h"
#include "apps/operate/screen.h"
#include "apps/operate/state_log.h"
#include "apps/operate/steering.h"
#include "apps/operate/time_line_panel.h"
#include "apps/operate/traces_panel.h"
#include "engine/run/thread_placement.h"

namespace fathom::operate {

// Frames go through the passes again, with the fixtures as they are in the panel; hand, tool and wrench
// are those of the files. Where a folder has no wrench.csv the hand is shown as its map has it, without tool.
// Everything on one thread. A GPU that is lost is opened again, the moment that is looked at stays.
class PlaybackRun {
public:
    // options.recording names the folder. Throws BadInput, Error, DeviceLost.
    PlaybackRun(const OperateOptions& options, const GlobalOptions& global);

    // Until the window is closed, the time is up or a signal.
    void run();

private:
    bool wantsToEnd() const;
    void frame(double dt);
    void draw(double dt);
    void loseDevice(const std::string& why);
    void lookForDevice(); // now and then, while there is none
    void listen();
    void followTime(double dt);
    void showMoment();
    uint32_t buttonsAt(double t) const;
    StateExtras extras() const;

    OperateOptions options_;
    StopSignals signals_;
    Window window_;
    Session session_;
    std::unique_ptr<Canvas> canvas_;
    HapticOptions haptics_;
    std::optional<HandPath> hand_;
    TickLog log_;
    PastScene past_;
    Recorder nothing_; // never started: the sink behind the sink
    SnapshotSink sink_;
    RunView view_;
    FixtureEditor editor_;
    Steering steering_;
    TimeLinePanel panel_;
    TracesPanel traces_;
    Screen screen_;
    Alarms alarms_;
    Console console_;
    StateLog state_;
    double retryAt_ = 0.0, retry_ = 0.0; // [s] when a device is looked for next; pause after that one
    double started_ = 0.0, shown_ = -1.0, windowHz_ = 0.0;
};

} // namespace fathom::operate
