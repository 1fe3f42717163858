// SPDX-License-Identifier: Apache-2.0
// How the bits of 16-bit depth images hold millimetres, judged by their values.
#pragma once

#include "devices/images/depth_image.h"
#include "devices/recorded/recording_layout.h"

#include <filesystem>
#include <vector>

namespace fathom {

// How 16-bit depth images store their values.
enum class DepthBits {
    Plain,
    Rotated, // to the left by three, as SUN3D and SUN RGB-D store them
    Either,  // one of these two
    Players  // as the Kinect SDK 1.x stores them: shifted by three, the number of a player in the low bits
};

// A few images over the whole index.
std::vector<std::filesystem::path> sampledImages(const RecordingLayout& layout);

// Judged from a few images, if the unit is 1 mm. Folders named like SUN3D's need less evidence. Images that
// cannot be read are ignored.
DepthBits depthBits(const RecordingLayout& layout, PngSize size, const DepthUnits& units);

} // namespace fathom
