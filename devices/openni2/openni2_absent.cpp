// SPDX-License-Identifier: Apache-2.0
// Replaces openni2_camera.cpp in builds without OpenNI2.
#include "devices/openni2/open_openni2.h"

#include "engine/types/error.h"

namespace fathom {

std::unique_ptr<Camera> openOpenNi2(const std::string& source) {
    throw BadInput("--source", "openni2", source,
                   "none: this program was built without OpenNI2 (install libopenni2-dev and rebuild)");
}

std::string openNi2Offer(uint16_t, uint16_t) {
    throw BadInput("openni2", "driver", "not built in",
                   "a program built with OpenNI2 (install libopenni2-dev and rebuild)");
}

} // namespace fathom
