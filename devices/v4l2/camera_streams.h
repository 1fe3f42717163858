// SPDX-License-Identifier: Apache-2.0
// The streams of one plugging-in of a V4l2Camera, kept until their last picture is given back.
#pragma once

#include "devices/v4l2/v4l2_camera.h"

namespace fathom {

struct V4l2Camera::Streams {
    CaptureStream depth;
    std::optional<CaptureStream> colour;
    std::atomic<uint32_t> leased{0}; // depth buffers in frames

    Streams(ChosenNodes nodes, const StreamRequest& depthRequest, const StreamRequest& colourRequest)
        : depth(std::move(nodes.depth), depthRequest) {
        if (nodes.colour) {
            colour.emplace(std::move(*nodes.colour), colourRequest);
        }
    }
    uint64_t missing() const { return depth.missing(); }
    uint64_t missingColour() const { return colour ? colour->missing() : 0; }
};

} // namespace fathom
