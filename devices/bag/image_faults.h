// SPDX-License-Identifier: Apache-2.0
// Whether a later image is of the camera and the kind that was chosen by the first ones.
#pragma once

#include "devices/bag/image_stream.h"
#include "engine/types/camera_info.h"

#include <string>

namespace fathom {

// Why a message is of another camera than the first one of its topic, by the frames in their headers; empty =
// it is not, or a header names none.
std::string otherFrame(const std::string& first, const std::string& now);

// Why the image is not one of the stream's, whose images `info` describes; empty = it is.
std::string depthFault(const ImageStream& stream, const ros::Image& image, const CameraInfo& info);
std::string colourFault(const ImageStream& stream, const ros::Image& image, const CameraInfo& info);

} // namespace fathom
