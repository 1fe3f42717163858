// SPDX-License-Identifier: Apache-2.0
#include "devices/camera.h"

namespace fathom {

std::vector<CameraStream> Camera::delivered() const {
    const CameraInfo& camera = info();
    const double rate = framePeriod() ? 1.0 / *framePeriod() : 0.0;
    std::vector<CameraStream> all{{"depth", camera.depth.width, camera.depth.height, rate, "16 bit"}};
    if (camera.hasColour) {
        all.push_back(
            {"colour", camera.colour.width, camera.colour.height, rate, nameOf(camera.colourFormat)});
    }
    return all;
}

} // namespace fathom
