// SPDX-License-Identifier: Apache-2.0
// `fathom operate SCENE`: the operator's window over a run in real time.
#pragma once

#include "apps/global_options.h"

#include <filesystem>
#include <string>

namespace CLI {
class App;
}

namespace fathom {

struct OperateOptions {
    std::filesystem::path scene;
    std::string source;       // recording folder; empty = the scene's camera
    std::string recording;    // folder to look back at; empty = a run
    bool armed = false;       // forces are asked for from the start: of `latency`, no option
    bool path = false;        // the scene's hand path drives, not mouse and keyboard
    std::string handDevice;   // a live hand (open_hand.h); empty = mouse and keyboard
    std::string viewEndpoint; // socket for observers (devices/bridge); empty = none
    std::string offscreen;    // WxH: the same frames without a surface; empty = a window
    std::string arm;          // serial line of the scene's real arm; empty = nothing moves
    std::string pilot;        // one of the scene's pilots; empty = the one that the file says
    double seconds = 0.0;     // ends by itself; 0 = when the window is closed
    double ticks = 0.0;       // [s] of turns after which it ends too, however late they were; 0 = never
    double textScale = 0.0;   // 0.75 .. 2; 0 = the scene's
    std::string state;        // file of JSON lines: what the window shows, for who watches it from outside
    std::string shots; // folder of screenshots (F12), recordings and exports; empty = the working folder
};

void addOperateCommand(CLI::App& app, const GlobalOptions& global);

} // namespace fathom
