// SPDX-License-Identifier: Apache-2.0
// A ROS 2 database of the RealSense SDK: its images are those of ROS, its lenses, poses and options texts.
// Source: librealsense b9d9454b, src/media/ros2.
#pragma once

#include "devices/bag/translated_file.h"

namespace fathom {

// Has the texts of camera_info, tf and the depth unit as the messages of ROS that the SDK's bags hold.
class RealSenseRecording final : public TranslatedFile {
public:
    static bool recognises(const MessageFile& file);
    // Throws Error.
    explicit RealSenseRecording(std::unique_ptr<MessageFile> original);

private:
    void translateTexts();
    void addUnit(const std::string& images);
};

} // namespace fathom
