// SPDX-License-Identifier: Apache-2.0
#include "devices/bag/orbbec_recording.h"

#include "devices/bag/ros2_messages.h"
#include "devices/bag/ros_messages.h"
#include "devices/bag/stream_names.h"
#include "devices/recorded/lens_model.h"
#include "engine/types/log.h"

#include <algorithm>
#include <array>
#include <cstring>

namespace fathom {

namespace {

constexpr const char* kProfile = "/cam/streamProfileType_";
constexpr const char* kDepthProfile = "/cam/streamProfileType_3";
constexpr const char* kColourProfile = "/cam/streamProfileType_2";
constexpr const char* kProperties = "/cam/property";
constexpr size_t kMaxProperties = 10'000; // messages

// OBPropertyID. Host means that the computer converts disparity, after the recording.
constexpr uint32_t kAlignedByCamera = 42, kPrecisionLevel = 75, kDepthByCamera = 85, kUnit = 176,
                   kDepthByHost = 3004;
constexpr std::array kUsed{kAlignedByCamera, kPrecisionLevel, kDepthByCamera, kUnit, kDepthByHost};
constexpr std::array kMillimetresOfLevel{1.0, 0.8, 0.4, 0.1, 0.2, 0.5, 0.05};

// A number in as many bytes as its type has: bool, int32 or, for the unit, float.
double numberOf(uint32_t id, std::span<const uint8_t> bytes) {
    ByteCursor cursor(bytes);
    if (bytes.size() == 1) {
        return cursor.value<uint8_t>();
    }
    return id == kUnit ? double{cursor.value<float>()} : 1.0 * cursor.value<int32_t>();
}

// A stream of images: not an inertial sensor or a lidar, whose profiles are other messages.
bool isVideo(const std::string& topic) {
    const std::string number = topic.starts_with(kProfile) ? topic.substr(std::strlen(kProfile)) : "";
    return !number.empty() && number != "4" && number != "5" && number != "10";
}

} // namespace

bool OrbbecRecording::recognises(const MessageFile& file) {
    return std::any_of(file.topics().begin(), file.topics().end(), [](const MessageTopic& topic) {
        return topic.name.starts_with(kProfile) || !orbbecSensor(topic.name).empty();
    });
}

OrbbecRecording::OrbbecRecording(std::unique_ptr<MessageFile> original)
    : TranslatedFile(std::move(original)) {
    readProfiles();
    readProperties();
    refuseDisparity();
    addPose();
    addUnit();
}

void OrbbecRecording::readProfiles() {
    for (MessageTopic& topic : topics_) {
        if (isVideo(topic.name)) {
            replace(topic, "sensor_msgs/CameraInfo", [&](const MessageCursor& message) {
                const OrbbecProfile read = orbbecProfile(message);
                if (topic.name == kDepthProfile && !depth_) {
                    depth_ = read;
                } else if (topic.name == kColourProfile && !colour_) {
                    colour_ = read;
                }
                return ros2::cameraInfo({}, read.lens);
            });
        }
    }
}

// The last value of each counts, as in the SDK.
void OrbbecRecording::readProperties() {
    const MessageTopic* topic = find(kProperties);
    const size_t count = topic == nullptr ? 0 : std::min(kMaxProperties, topic->messages.size());
    for (size_t i = 0; i < count; ++i) {
        try {
            MessageCursor message = read(*topic, i);
            ros::skipHeader(message);
            const uint32_t id = message.word();
            if (std::find(kUsed.begin(), kUsed.end(), id) != kUsed.end()) {
                properties_[id] = numberOf(id, message.block());
            }
        } catch (const Error& e) {
            log::warn("{}: {}: message {} is skipped: {}", file().string(), kProperties, i, e.what());
        }
    }
}

bool OrbbecRecording::isOn(uint32_t property) const {
    const auto found = properties_.find(property);
    return found != properties_.end() && found->second != 0.0;
}

void OrbbecRecording::refuseDisparity() const {
    const bool known = properties_.contains(kDepthByCamera);
    if (known ? !isOn(kDepthByCamera) : isOn(kDepthByHost)) {
        throw BadInput(file().string(), kProperties,
                       known ? "85 (conversion of disparity to depth by the camera) is off: the images of "
                               "depth are disparity"
                             : "3004 (conversion of disparity to depth by the computer) is on: the images of "
                               "depth are disparity",
                       "a recording of depth: switch property 85 on, or save a bag of ROS");
    }
}

void OrbbecRecording::addPose() {
    std::optional<Pose> pose = depth_ ? depth_->colourTdepth : std::nullopt;
    if (isOn(kAlignedByCamera) && depth_) {
        if (!colour_ || !sameLens(depth_->lens, colour_->lens)) {
            throw BadInput(
                file().string(), kProperties,
                "42 (alignment of depth to colour by the camera) is on, and the lens of the aligned "
                "images is not recorded",
                "a recording with property 42 off");
        }
        pose = Pose{};
    }
    if (pose) {
        add("/cam/extrinsics/depth_to_color", "realsense2_camera_msgs/Extrinsics", ros2::extrinsics(*pose));
    }
}

void OrbbecRecording::addUnit() {
    constexpr double kMetres = 1e-3; // per millimetre
    const auto level = properties_.find(kPrecisionLevel), unit = properties_.find(kUnit);
    double millimetres = 0.0;
    if (unit != properties_.end() && unit->second > 0.0) {
        millimetres = unit->second;
    } else if (level != properties_.end()) {
        if (!(level->second >= 0.0 && level->second < kMillimetresOfLevel.size())) {
            throw BadInput(file().string(), kProperties,
                           "75 (precision level) is " + std::to_string(static_cast<int64_t>(level->second)),
                           "0 to 6");
        }
        millimetres = kMillimetresOfLevel[static_cast<size_t>(level->second)];
    } else {
        return; // said by the camera
    }
    add("/cam/sensor_3/option/Depth_Units/value", "std_msgs/Float32",
        ros2::float32(static_cast<float>(kMetres * millimetres)));
}

} // namespace fathom
