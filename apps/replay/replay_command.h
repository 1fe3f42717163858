// SPDX-License-Identifier: Apache-2.0
// `fathom replay SCENE`: the main job headless. Frames in, hand motion in, wrench out.
#pragma once

#include "apps/global_options.h"

#include <filesystem>
#include <string>

namespace CLI {
class App;
}

namespace fathom {

struct ReplayOptions {
    std::filesystem::path scene;
    std::string source;       // recording folder; empty = the scene's camera
    std::string operatorCsv;  // hand path; empty = the scene's
    std::string query;        // cpu, gpu; empty = the scene's
    bool hand = false;        // close the loop with the simulated hand
    std::string handDevice;   // live device (apps/binding/open_hand.h); empty = none
    std::string viewEndpoint; // socket for observers (devices/bridge); empty = none
    std::string arm;          // serial line of the scene's real arm; empty = nothing moves
    double seconds = 0.0;     // that a run with a live device lasts at least
    double frameRate = 0.0;   // [Hz] of a camera that is not live, by the clock; 0 = 30
    bool realtime = false;
    bool saveFixtures = false;
    std::filesystem::path out;
};

// result: 0, or 1 when a stated limit does not hold.
void addReplayCommand(CLI::App& app, const GlobalOptions& global, int& result);

} // namespace fathom
