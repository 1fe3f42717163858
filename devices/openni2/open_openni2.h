// SPDX-License-Identifier: Apache-2.0
// PrimeSense, Xtion and their recordings through OpenNI2, where this program was built with it.
#pragma once

#include "devices/camera.h"

#include <cstdint>
#include <memory>
#include <string>

namespace fathom {

// "openni2", "openni2:URI", "openni2:FILE.oni" or "FILE.oni", each with ",intrinsics=FILE" (of a recording
// folder: takes the place of what the device tells) and ",registered=yes" (an .oni file does not tell whether
// its colour is registered to depth).
bool isOpenNi2Request(const std::string& source);

// Throws BadInput: not built in, no device, a file that is none, no depth, no known field of view.
std::unique_ptr<Camera> openOpenNi2(const std::string& source);

// What the camera of that USB number can do, in one line: "depth 640x480, colour 640x480; --source
// openni2:URI". Opens it for a moment. Throws BadInput: not built in, no driver for it, not to be opened.
std::string openNi2Offer(uint16_t vendor, uint16_t product);

} // namespace fathom
