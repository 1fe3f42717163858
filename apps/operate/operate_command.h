// SPDX-License-Identifier: Apache-2.0
// `fathom operate SCENE`: the operator's window over a realtime run.
#pragma once

#include "apps/binding/run_observers.h"
#include "apps/session/session.h"

namespace CLI {
class App;
}

namespace fathom {

struct OperateOptions : SessionOptions {
    OperateOptions() { endless = true; }

    ObserverOptions observers;
    bool armed = false;           // forces on from the start: for `latency` and `--offscreen --path`
    bool path = false;            // the scene's hand path drives instead of mouse and keyboard
    std::string offscreen;        // WxH: draws without a surface; empty = a window
    double seconds = 0.0;         // ends after this time; 0 = when the window is closed
    double runTime = 0.0;         // [s] ends when the clock of the run reaches this; 0 = never
    double textScale = 0.0;       // 0.75 to 2.5; 0 = the scene's
    std::string state;            // file of JSON lines with the state of the window, for other programs
    bool appendsState = false;    // to the lines of an earlier window of this process
    std::vector<std::string> job; // lines under exported images
    bool fromLiveRun = false;     // opened from a live run, to which its window may return
    std::string notice;           // shown at the start
    std::string shots; // folder for screenshots (F12), recordings and exports; empty = the working directory
};

void addOperateCommand(CLI::App& app, const GlobalOptions& global);

} // namespace fathom
