// SPDX-License-Identifier: Apache-2.0
// Fills a frame from a pair of driver buffers.
#include "devices/v4l2/camera_streams.h"
#include "devices/v4l2/pixel_format.h"
#include "devices/v4l2/v4l2_camera.h"

namespace fathom {

namespace {

constexpr uint32_t kDriverKeeps = 2; // buffers; a lease that would leave fewer is a copy

} // namespace

std::string V4l2Camera::fill(const FramePairing::Pair& pair, FrameSlot& slot, Frame::Content& content) {
    if (pair.depth.damaged) {
        return "the driver marks it as damaged";
    }
    if (pair.depth.stamp < lastStamp_) {
        return "its time stamp goes back";
    }
    if (!fillDepth(pair.depth, slot, content)) {
        return "short: " + std::to_string(pair.depth.bytes.size()) + " bytes";
    }
    if (pair.colour && info_.hasColour) {
        if (pair.colour->damaged) {
            return "the driver marks its colour frame as damaged";
        }
        return fillColour(*pair.colour, slot, content);
    }
    return "";
}

std::string V4l2Camera::fillColour(const CapturedBuffer& colour, FrameSlot& slot, Frame::Content& content) {
    return copyColour(colourRequest_.fourcc, colourRequest_.size, streams_->colour->stride(), colour.bytes,
                      slot.colourBytes(), content.raw);
}

// Returns false when bytes are missing.
bool V4l2Camera::fillDepth(const CapturedBuffer& depth, FrameSlot& slot, Frame::Content& content) {
    const uint32_t stride = streams_->depth.stride();
    if (depth.bytes.size() < imageBytes(depthRequest_.fourcc, depthRequest_.size, stride)) {
        return false;
    }
    const DepthLayout layout = *depthLayout(depthRequest_.fourcc);
    const uint32_t width = info_.depth.width;
    if (!layout.packed && layout.mask == 0xffff && layout.rowBytes(width, stride) == 2 * width &&
        streams_->depth.queued() >= kDriverKeeps) {
        const auto* first = reinterpret_cast<const uint16_t*>(depth.bytes.data());
        content.depth = {first + size_t{layout.planesBefore} * info_.depth.pixels(), info_.depth.pixels()};
        return true;
    }
    unpackDepth(layout, depthRequest_.size, stride, depth.bytes, slot.depth());
    content.depth = slot.depth().first(info_.depth.pixels());
    return true;
}

} // namespace fathom
