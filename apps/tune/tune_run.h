// SPDX-License-Identifier: Apache-2.0
// One run of `fathom tune`: opens scene and device, measures, and writes scene, table and plot.
#pragma once

#include "apps/global_options.h"
#include "apps/tune/tune_choice.h"

#include <string>

namespace fathom::tune {

// From the command line.
struct TuneSettings {
    std::string scene, source, out; // files and a folder; source empty = the scene's camera
    Request request;
    uint32_t frames = 24; // per point
    double limit = 120.0; // [s]
};

// Exit code: 0, or 1 when no point meets the request; then there is no scene. Throws BadInput or Error.
int runTune(const TuneSettings& settings, const GlobalOptions& global);

} // namespace fathom::tune
