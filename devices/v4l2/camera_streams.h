// SPDX-License-Identifier: Apache-2.0
// The streams of one plugging-in of a V4l2Camera, kept until their last picture is given back.
#pragma once

#include "devices/v4l2/frame_metadata.h"
#include "devices/v4l2/v4l2_camera.h"

namespace fathom {

// Depth, colour where there is one, and metadata where the camera gives it.
struct V4l2Camera::Streams {
    std::unique_ptr<MetadataStream> metadata; // of depth; may be none. Runs before the first picture
    CaptureStream depth;
    std::optional<CaptureStream> colour;
    std::atomic<uint32_t> leased{0}; // depth buffers in frames

    Streams(ChosenNodes nodes, const StreamRequest& depthRequest, const StreamRequest& colourRequest)
        : metadata(MetadataStream::beside(nodes.depth))
        , depth(std::move(nodes.depth), depthRequest) {
        if (nodes.colour) {
            colour.emplace(std::move(*nodes.colour), colourRequest);
        }
    }
    // The oldest depth picture that is ready, with when its exposure began where that is told.
    std::optional<CapturedBuffer> takeDepth() {
        auto buffer = depth.take();
        if (buffer && metadata) {
            buffer->exposure = metadata->exposureStart(buffer->sequence, buffer->stamp);
        }
        return buffer;
    }
    uint64_t missing() const { return depth.missing(); }
    uint64_t missingColour() const { return colour ? colour->missing() : 0; }
};

} // namespace fathom
