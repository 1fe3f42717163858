// SPDX-License-Identifier: Apache-2.0
// Lenses, depth unit and extrinsics of a live camera: from a file of the user's, or from the camera itself.
#pragma once

#include "devices/v4l2/choose_nodes.h"
#include "engine/types/camera_info.h"

namespace fathom {

struct LiveCalibration {
    CameraInfo info;    // of the pictures to be streamed
    std::string origin; // where the figures come from, for the user
};

// Throws BadInput when neither has them, or when they are of other sizes than the request's. A RealSense
// without a colour calibration (D430: it has no such sensor) goes on with depth alone, said in the log: then
// the colour node that was chosen by itself is let go.
LiveCalibration calibrationFor(const CameraRequest& request, ChosenNodes& nodes);

} // namespace fathom
