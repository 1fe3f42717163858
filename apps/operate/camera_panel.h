// SPDX-License-Identifier: Apache-2.0
// The tab of the camera: streams, delay from exposure to force, controls.
#pragma once

#include "apps/operate/camera_control_thread.h"
#include "apps/operate/console.h"
#include "apps/operate/run_view.h"
#include "apps/operate/theme.h"

#include <string>
#include <vector>

namespace fathom::operate {

// The camera of a run.
struct CameraFacts {
    std::string description;
    std::vector<CameraStream> streams;
    bool live = false;
    bool stampsExposure = false; // the delay begins at the start of exposure
};

// Sends requests to the control thread.
void drawCamera(Console& console, const CameraFacts& camera, const RunView& run,
                CameraControlThread& controlThread, const Fonts& fonts);

// Why there is nothing to set; empty = there is.
std::string whyNoControls(const CameraFacts& camera, const CameraControlThread& controlThread);

} // namespace fathom::operate
