// SPDX-License-Identifier: Apache-2.0
// `fathom replay SCENE`: runs the engine without a window on recorded frames and hand motion, and writes the
// results to files.
#pragma once

#include "apps/binding/run_observers.h"
#include "apps/session/session.h"

namespace CLI {
class App;
}

namespace fathom {

struct ReplayOptions : SessionOptions {
    ReplayOptions() { realtime = false; }

    bool hand = false; // closes the loop with a simulated hand
    // Whether it is closed: on request, or because the scene's own path has a hand that yields.
    bool yields(const Scene& loaded) const { return hand || (loaded.hand.yields && operatorCsv.empty()); }
    ObserverOptions observers;
    double seconds = 0.0;   // [s] minimum length of a run with a live device
    double frameRate = 0.0; // [Hz] frame rate of a camera that is not live; 0 = 30
    bool saveFixtures = false;
    bool strict = false; // warnings give exit code 1
    std::filesystem::path out;
};

// result: exit code, 0, or 1 when a documented limit is violated.
void addReplayCommand(CLI::App& app, const GlobalOptions& global, int& result);

} // namespace fathom
