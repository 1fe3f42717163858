// SPDX-License-Identifier: Apache-2.0
#include "devices/ros2/open_ros2.h"

#include "devices/ros2/ros2_camera.h"

namespace fathom {

std::unique_ptr<Camera> openRos2(const std::string& source, bool everyFrame, double farthest) {
    Ros2Request request = parseRos2Request(source);
    request.everyFrame = everyFrame;
    request.options.farthest = farthest;
    return std::make_unique<Ros2Camera>(request);
}

} // namespace fathom
