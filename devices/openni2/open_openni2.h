// SPDX-License-Identifier: Apache-2.0
// PrimeSense, Xtion and their recordings through OpenNI2, when built with it.
#pragma once

#include "devices/camera.h"

#include <cstdint>
#include <memory>
#include <string>

namespace fathom {

// "openni2", "openni2:URI", "openni2:FILE.oni" or "FILE.oni", each with ",intrinsics=FILE" (of a recording
// folder: replaces the device's own values) and ",registered=yes" (an .oni file does not state whether its
// colour is registered to depth).
bool isOpenNi2Request(const std::string& source);

// Throws BadInput: not built in, no device, an invalid file, no depth, or unknown field of view.
std::unique_ptr<Camera> openOpenNi2(const std::string& source);

// Capabilities of the camera with that USB number, in one line: "depth 640x480, colour 640x480; --source
// openni2:URI". Opens it briefly. Throws BadInput: not built in, no driver, or it cannot be opened.
std::string openNi2Offer(uint16_t vendor, uint16_t product);

} // namespace fathom
