// SPDX-License-Identifier: Apache-2.0
// Lenses, depth unit and extrinsics of a live camera, from a user's file or from the camera.
#pragma once

#include "devices/v4l2/choose_nodes.h"
#include "engine/types/camera_info.h"

namespace fathom {

struct LiveCalibration {
    CameraInfo info;    // of the streams
    std::string origin; // source of the values, for display
};

// Throws BadInput when neither has them, or when their size differs from the request. A RealSense without
// colour calibration (D430 has no colour sensor) continues with depth only, with a log line; an automatically
// chosen colour node is then released.
LiveCalibration calibrationFor(const CameraRequest& request, ChosenNodes& nodes);

} // namespace fathom
