// SPDX-License-Identifier: Apache-2.0
#include "devices/bag/image_faults.h"

#include <utility>

namespace fathom {

std::string otherFrame(const std::string& first, const std::string& now) {
    return first == now || first.empty() || now.empty()
               ? ""
               : "its frame is '" + now + "', that of the first one '" + first + "'";
}

std::string depthFault(const ImageStream& stream, const ros::Image& image, const CameraInfo& info) {
    const bool alike = (image.compressed ? image.format : image.encoding) == stream.encoding;
    if (!alike || ros::sizeOf(image) != std::pair(info.depth.width, info.depth.height)) {
        return "size or encoding differs from the first image";
    }
    return otherFrame(stream.frame, image.frame);
}

std::string colourFault(const ImageStream& stream, const ros::Image& image, const CameraInfo& info) {
    if (ros::sizeOf(image) != std::pair(info.colour.width, info.colour.height)) {
        return "size differs from its camera_info";
    }
    if (const std::string other = otherFrame(stream.frame, image.frame); !other.empty()) {
        return other;
    }
    return ros::colourFormat(image) == info.colourFormat ? "" : "encoding differs from the first image";
}

} // namespace fathom
