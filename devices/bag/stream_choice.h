// SPDX-License-Identifier: Apache-2.0
// The depth and colour streams of a file of messages that are played, with their lenses and their pose.
#pragma once

#include "devices/bag/image_stream.h"
#include "engine/types/camera_info.h"

#include <optional>
#include <string>
#include <vector>

namespace fathom {

// What StreamChooser chose.
struct StreamChoice {
    ImageStream depth;
    std::optional<ImageStream> colour;
    CameraInfo camera;                 // lenses, registration, extrinsics; not the depth unit
    std::string summary;               // what was chosen, and what else there is, in one line
    bool rangeImages = false;          // depth holds ranges along the rays
    std::vector<std::string> warnings; // why colour or depth may be wrong
    std::string unread;                // image topics that may be colour but whose encoding is not read
    std::optional<double> statedUnit;  // [m] by the file of the lens
    std::string unreadScale;           // RecordingIntrinsics::unreadScale
    std::string unitWarning;           // that of the file, if its unit counts
};

} // namespace fathom
