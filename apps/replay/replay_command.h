// SPDX-License-Identifier: Apache-2.0
// `fathom replay SCENE`: the main job headless. Frames in, hand motion in, wrench out.
#pragma once

#include "apps/session/session.h"

namespace CLI {
class App;
}

namespace fathom {

struct ReplayOptions : SessionOptions {
    ReplayOptions() { realtime = false; }

    bool hand = false;        // close the loop with the simulated hand
    std::string viewEndpoint; // socket for observers (devices/bridge); empty = none
    double seconds = 0.0;     // that a run with a live device lasts at least
    double frameRate = 0.0;   // [Hz] of a camera that is not live, by the clock; 0 = 30
    bool saveFixtures = false;
    std::filesystem::path out;
};

// result: 0, or 1 when a stated limit does not hold.
void addReplayCommand(CLI::App& app, const GlobalOptions& global, int& result);

} // namespace fathom
