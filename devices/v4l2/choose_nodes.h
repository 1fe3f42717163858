// SPDX-License-Identifier: Apache-2.0
// Selects video nodes and formats for a request.
#pragma once

#include "devices/v4l2/camera_request.h"

#include <optional>

namespace fathom {

// The opened nodes for a request, each with its format (fourcc).
struct ChosenNodes {
    VideoNode depth;
    uint32_t depthFormat = 0;
    std::optional<VideoNode> colour;
    uint32_t colourFormat = 0;
};

// Identity of a lost camera, to find it again at any node.
struct KnownCamera {
    std::string depthIdentity, colourIdentity; // VideoNode::identity(); colour empty = none
};

// Throws BadInput that lists what is available.
ChosenNodes chooseNodes(const CameraRequest& request, const std::optional<KnownCamera>& known = std::nullopt);

} // namespace fathom
