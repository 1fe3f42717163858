// SPDX-License-Identifier: Apache-2.0
// The images of a Matroska track as sensor_msgs/Image.
#pragma once

#include "devices/bag/matroska_header.h"

namespace fathom {

// One track. encoding: of sensor_msgs/Image; empty where its blocks are not images that are read.
struct MatroskaImages {
    std::string name, encoding;
    uint32_t width = 0, height = 0, step = 0; // [pixels], [bytes] per row; 0: compressed
    bool bigEndian = false;

    MatroskaImages(const MatroskaTrack& track, std::string name);
    // As ROS 1 serialises it; the data alone where there is no encoding. time: [ns].
    std::vector<uint8_t> message(uint64_t time, std::span<const uint8_t> data) const;
};

} // namespace fathom
