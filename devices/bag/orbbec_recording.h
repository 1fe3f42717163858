// SPDX-License-Identifier: Apache-2.0
// A recording of the Orbbec SDK (OrbbecViewer): a ROS 1 bag with images as those of ROS, and with lenses,
// poses and units in messages of its own. Source: OrbbecSDK_v2 869ae2d0, src/media and 3rdparty/rosbag.
#pragma once

#include "devices/bag/orbbec_profile.h"
#include "devices/bag/translated_file.h"

#include <map>
#include <optional>

namespace fathom {

// Has /cam/streamProfileType_N as sensor_msgs/CameraInfo, and adds the pose from depth to colour and the unit
// of depth as topics.
class OrbbecRecording final : public TranslatedFile {
public:
    static bool recognises(const MessageFile& file);
    // Throws BadInput: the images are disparity, or the camera aligned them in a way that is not recorded.
    explicit OrbbecRecording(std::unique_ptr<MessageFile> original);

private:
    void readProfiles();
    void readProperties();
    bool isOn(uint32_t property) const; // false also when it was not recorded
    void refuseDisparity() const;
    void addPose();
    void addUnit();

    std::optional<OrbbecProfile> depth_, colour_;
    std::map<uint32_t, double> properties_; // by id; only those that are used
};

} // namespace fathom
