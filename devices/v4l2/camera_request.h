// SPDX-License-Identifier: Apache-2.0
// A request for a live camera, in one line: "v4l2:DEVICE[,NAME=VALUE]...".
#pragma once

#include "devices/v4l2/video_node.h"

#include <filesystem>
#include <optional>
#include <string>

namespace fathom {

struct CameraRequest {
    std::string text;                          // as given, for messages
    std::string device = "auto";               // /dev/videoN with depth; auto = the first camera that has it
    std::string colour = "auto";               // /dev/videoN; auto = of the same camera, if any; none
    uint32_t format = 0;                       // depth format by name; 0 = any format that is always depth
    uint32_t colourFormat = 0;                 // 0 = best available
    std::optional<VideoSize> size, colourSize; // default: the intrinsics', else 640x480
    double rate = 30.0;                        // [1/s]
    double colourRate = 0.0;                   // [1/s] of colour; 0 = as depth
    double rateOfColour() const { return colourRate > 0.0 ? colourRate : rate; }
    std::filesystem::path
        intrinsics;          // like intrinsics.json of a recording; empty = read them from the camera
    uint64_t frames = 0;     // the source ends after this many; 0 = never
    bool everyFrame = false; // deliver every frame, even late ones, not only the newest (for recording)
    double silence = 3.0;    // [s] without a frame until the stream is restarted; lost after twice that

    static constexpr const char* kAllowed =
        "v4l2:auto or v4l2:/dev/videoN, then any of ,colour=auto|none|/dev/videoN ,format=NAME "
        ",colour_format=NAME ,size=WxH ,colour_size=WxH ,rate=N ,colour_rate=N ,intrinsics=FILE "
        ",frames=N";
};

// True when `text` names a live camera rather than a file.
bool isCameraRequest(const std::string& text);

// `text` with or without the leading "v4l2:". Throws BadInput.
CameraRequest parseCameraRequest(const std::string& text);

} // namespace fathom
