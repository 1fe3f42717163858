// SPDX-License-Identifier: Apache-2.0
// Targets that read messages, and files of messages of cameras' own.
#include "devices/bag/bag_camera.h"
#include "devices/bag/cloud_message.h"
#include "devices/bag/image_stream.h"
#include "devices/bag/kinect_calibration.h"
#include "devices/bag/matroska_file.h"
#include "devices/bag/orbbec_recording.h"
#include "devices/bag/realsense_recording.h"
#include "engine/types/error.h"
#include "tests/fuzz/fuzz_target.h"

#include <array>
#include <cmath>

namespace fathom::testing {

namespace {

constexpr size_t kMaxMessages = 8; // of a topic that are read

// Messages that are in memory: of an input in records of a topic's number, a length (16 bits) and a message.
class RecordedBytes final : public MessageFile {
public:
    struct Topic {
        const char *name, *type;
    };
    RecordedBytes(std::span<const Topic> topics, bool cdr, Bytes records)
        : MessageFile("recording") {
        for (ByteCursor cursor(records); cursor.left() > 3;) {
            const Topic& topic = topics[cursor.value<uint8_t>() % topics.size()];
            const size_t size = std::min<size_t>(cursor.value<uint16_t>(), cursor.left());
            topics_[topicAt(topic.name, topic.type, cdr)].messages.push_back(
                {messages_.size() * 30'000'000, 0, messages_.size()});
            messages_.push_back(cursor.take(size));
        }
    }
    MessageBytes bytes(const MessageEntry& entry) override { return {messages_[entry.offset], nullptr}; }

private:
    std::vector<Bytes> messages_;
};

constexpr std::array kOrbbecTopics{
    RecordedBytes::Topic{"/cam/sensor_3/frameType_3", "sensor_msgs/Image"},
    RecordedBytes::Topic{"/cam/sensor_2/frameType_2", "sensor_msgs/Image"},
    RecordedBytes::Topic{"/cam/streamProfileType_3", "custom_msg/OBStreamProfileInfo"},
    RecordedBytes::Topic{"/cam/streamProfileType_2", "custom_msg/OBStreamProfileInfo"},
    RecordedBytes::Topic{"/cam/property", "custom_msg/OBProperty"}};
constexpr std::array kRealSenseTopics{
    RecordedBytes::Topic{"/device_0/sensor_0/Depth_0/image/data", "sensor_msgs/msg/Image"},
    RecordedBytes::Topic{"/device_0/sensor_1/Color_0/image/data", "sensor_msgs/msg/Image"},
    RecordedBytes::Topic{"/device_0/sensor_0/Depth_0/camera_info", "std_msgs/msg/String"},
    RecordedBytes::Topic{"/device_0/sensor_1/Color_0/camera_info", "std_msgs/msg/String"},
    RecordedBytes::Topic{"/device_0/sensor_0/Depth_0/tf/ref_0", "std_msgs/msg/String"},
    RecordedBytes::Topic{"/device_0/sensor_1/Color_0/tf/ref_0", "std_msgs/msg/String"},
    RecordedBytes::Topic{"/device_0/sensor_0/option/Depth_Units/value", "std_msgs/msg/String"},
    RecordedBytes::Topic{"/device_0/sensor_0/Depth_0/image/metadata", "std_msgs/msg/String"}};

bool soundPose(const Pose& pose) {
    return isFinite(pose) && std::abs(glm::length(pose.rotation) - 1.0) < 1e-9;
}

bool soundLens(const Intrinsics& lens) {
    return std::isfinite(lens.fx + lens.fy + lens.cx + lens.cy);
}

void readOf(uint8_t kind, const MessageCursor& message) {
    switch (kind % 8) {
    case 0:
        need(ros::image(message).data.size() <= message.left());
        break;
    case 1:
        need(ros::compressedImage(message).data.size() <= message.left());
        break;
    case 2:
        need(soundLens(ros::cameraInfo(message).raw) && soundLens(ros::cameraInfo(message).rectified));
        break;
    case 3:
        need(soundPose(ros::transform(message)));
        break;
    case 4:
        need(soundPose(ros::extrinsics(message, ros::ExtrinsicsOf::RealSense)));
        need(soundPose(ros::extrinsics(message, ros::ExtrinsicsOf::Orbbec)));
        break;
    case 5:
        for (const ros::FrameLink& link : ros::frameLinks(message)) {
            need(soundPose(link.parentTchild));
        }
        break;
    case 6: {
        const ros::Cloud cloud = ros::cloud(message);
        if (!ros::whyNoDepth(cloud).empty() || uint64_t{cloud.width} * cloud.height > 1u << 16) {
            throw Error("no depth, or too large to be quick");
        }
        ros::pointsOrder(cloud); // any order
        double largest = 0.0;
        need(ros::pointsOf(cloud, largest).points.size() == size_t{cloud.width} * cloud.height);
        break;
    }
    default:
        const OrbbecProfile profile = orbbecProfile(message);
        need(!profile.colourTdepth || soundPose(*profile.colourTdepth));
    }
}

} // namespace

// The first byte selects the message, and in its highest bit ROS 2.
void readMessage(Bytes input) {
    if (input.empty()) {
        throw Error("empty");
    }
    readOf(input[0], MessageCursor(input.subspan(1), input[0] >= 128));
}

// The first byte selects the maker.
void readSdkMessages(Bytes input) {
    if (input.empty()) {
        throw Error("empty");
    }
    const Bytes records = input.subspan(1);
    std::unique_ptr<MessageFile> file;
    if (input[0] % 2 == 0) {
        file =
            std::make_unique<OrbbecRecording>(std::make_unique<RecordedBytes>(kOrbbecTopics, false, records));
    } else {
        file = std::make_unique<RealSenseRecording>(
            std::make_unique<RecordedBytes>(kRealSenseTopics, true, records));
    }
    BagCamera camera(std::move(file), {});
    drain(camera);
}

// Every message of every track, because the images of a real mode are too large to be fuzzed.
void readMatroska(Bytes input) {
    MatroskaFile file(fuzzFile("recording.mkv", input));
    for (const MessageTopic& topic : file.topics()) {
        for (size_t i = 0; i < std::min(kMaxMessages, topic.messages.size()); ++i) {
            need(file.bytes(topic.messages[i]).view.size() <= input.size() + 1000);
        }
    }
    for (const ImageStream& stream : imageStreams(file, "")) {
        need(stream.lens.has_value() || !stream.noLens.empty());
        need(!stream.lens || soundLens(*stream.lens));
    }
}

void readKinectCalibration(Bytes input) {
    const KinectCalibration calibration({input.begin(), input.end()}, "calibration.json");
    need(soundPose(calibration.colourTdepth()));
    need(soundLens(calibration.depth(640, 576)) && soundLens(calibration.colour(1920, 1080)));
}

} // namespace fathom::testing
