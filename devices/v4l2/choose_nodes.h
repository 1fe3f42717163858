// SPDX-License-Identifier: Apache-2.0
// Which video nodes and formats serve a request.
#pragma once

#include "devices/v4l2/camera_request.h"

#include <optional>

namespace fathom {

// The nodes that serve a request, opened, and the format (fourcc) to ask each for.
struct ChosenNodes {
    VideoNode depth;
    uint32_t depthFormat = 0;
    std::optional<VideoNode> colour;
    uint32_t colourFormat = 0;
};

// A camera that was open once and is looked for again, wherever its nodes are now.
struct KnownCamera {
    std::string depthIdentity, colourIdentity; // VideoNode::identity(); colour empty = none
};

// Throws BadInput that says what there is instead.
ChosenNodes chooseNodes(const CameraRequest& request, const std::optional<KnownCamera>& known = std::nullopt);

} // namespace fathom
