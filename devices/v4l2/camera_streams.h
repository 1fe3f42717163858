// SPDX-License-Identifier: Apache-2.0
// The streams of a V4l2Camera from plug-in to unplugging, kept until the last frame is released.
#pragma once

#include "devices/v4l2/frame_metadata.h"
#include "devices/v4l2/v4l2_camera.h"

namespace fathom {

// Depth, optional colour, and optional metadata.
struct V4l2Camera::Streams {
    std::unique_ptr<MetadataStream> metadata; // of depth; optional. Runs before the first frame
    CaptureStream depth;
    std::optional<CaptureStream> colour;
    std::atomic<uint32_t> leased{0}; // depth buffers leased by frames

    Streams(ChosenNodes nodes, const StreamRequest& depthRequest, const StreamRequest& colourRequest)
        : metadata(MetadataStream::openFor(nodes.depth))
        , depth(std::move(nodes.depth), depthRequest) {
        if (nodes.colour) {
            colour.emplace(std::move(*nodes.colour), colourRequest);
        }
    }
    // The oldest depth frame that is ready, with its start of exposure if reported.
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
