// SPDX-License-Identifier: Apache-2.0
// `fathom operate SCENE`: the operator's window over a run in real time.
#pragma once

#include "apps/session/session.h"

namespace CLI {
class App;
}

namespace fathom {

struct OperateOptions : SessionOptions {
    OperateOptions() { endless = true; }

    bool armed = false;       // forces on from the start: of `latency` and of `--offscreen --path`
    bool path = false;        // the scene's hand path drives, not mouse and keyboard
    std::string viewEndpoint; // socket for observers (devices/bridge); empty = none
    std::string offscreen;    // WxH: the same frames without a surface; empty = a window
    double seconds = 0.0;     // ends by itself; 0 = when the window is closed
    double ticks = 0.0;       // [s] of ticks after which it ends too, however late they were; 0 = never
    double textScale = 0.0;   // 0.75 .. 2; 0 = the scene's
    std::string state;        // file of JSON lines: what the window shows, for who watches it from outside
    std::string shots; // folder of screenshots (F12), recordings and exports; empty = the working folder
};

void addOperateCommand(CLI::App& app, const GlobalOptions& global);

} // namespace fathom
