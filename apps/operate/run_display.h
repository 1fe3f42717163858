// SPDX-License-Identifier: Apache-2.0
// The window on a session: console, views, panels, state file, and the pace of frames.
#pragma once

#include "apps/operate/alarms.h"
#include "apps/operate/canvas.h"
#include "apps/operate/frame_pace.h"
#include "apps/operate/operate_command.h"
#include "apps/operate/screen.h"
#include "apps/operate/state_log.h"
#include "apps/operate/traces_panel.h"
#include "apps/session/session.h"

namespace fathom::operate {

// Window thread. Options, window, session and sink outlive it. For live runs and for recordings.
struct RunDisplay {
    // Opens the canvas on the session's device. Throws Error, DeviceLost; BadInput if the folder of the last
    // screenshot cannot be written.
    RunDisplay(const OperateOptions& options, Window& window, Session& session, SnapshotSink& sink);

    void begin();        // the time of the run counts from now
    double beginFrame(); // waits for the window's next frame; returns the time since the last one [s]
    // Call at the end. True where the run ends with a screenshot, since no key can request one: offscreen,
    // with a folder. The caller then draws one more frame, which has begun.
    bool beginLastShot();
    void checkLastShot() const; // at the very end; throws Error if that screenshot is not written
    void followClosing(FixtureEditor& editor, bool forcesGone); // the window's close button (closing.h)
    // True when the window is closed or the time is up.
    bool wantsToEnd() const;
    double elapsed() const;                           // [s] since begin()
    double frameCost() const { return pace_.cost(); } // [s] of CPU time of the window's thread

    HudInput hud(const HapticOptions& haptics); // the parts that are the same for every run
    void draw(FixtureEditor& editor, const ScreenInput& input);
    void exportTraces(); // if requested: traces.csv in the folder of the options

    // Writes the state file. measured: null = no real arm.
    void writeState(const FixtureEditor& editor, const HapticOptions& haptics, const ShownArm* measured,
                    const HandDeviceFacts& device, bool now);

    Console console;
    Canvas canvas;
    RunView view;
    Screen screen;
    Alarms alarms;

private:
    bool endsWithShot() const { return window_.offscreen() && !options_.shots.empty(); }

    const OperateOptions& options_;
    Window& window_;
    Session& session_;
    TracesPanel traces_;
    CameraFacts camera_;
    CameraControlThread controlThread_;
    FramePace pace_;
    StateLog log_;
    double started_ = 0.0, lastFrame_ = 0.0; // [s] of the steady clock
    double windowHz_ = 0.0;
};

} // namespace fathom::operate
