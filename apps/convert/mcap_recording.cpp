// SPDX-License-Identifier: Apache-2.0
#include "apps/convert/mcap_recording.h"

#include "apps/convert/message_time.h"
#include "devices/bag/ros2_messages.h"
#include "engine/types/colour_copy.h"
#include "engine/types/error.h"

#include <cmath>
#include <cstring>

namespace fathom {

namespace {

constexpr const char* kDepthFrame = "camera_depth_optical_frame";
constexpr const char* kColourFrame = "camera_color_optical_frame";
constexpr const char* kImage = "sensor_msgs/msg/Image";
constexpr const char* kInfo = "sensor_msgs/msg/CameraInfo";
constexpr const char* kTransforms = "tf2_msgs/msg/TFMessage";

const CameraInfo& writable(const std::filesystem::path& file, const CameraInfo& camera) {
    if (camera.depth.fan) {
        throw BadInput(file.string(), "lens", "a fan of beams", "a pinhole; or --format tum");
    }
    if (std::filesystem::exists(file)) {
        throw BadInput("--out", file.string(), "exists", "a folder without a recording");
    }
    return camera;
}

bool inMillimetres(const CameraInfo& camera) {
    return std::abs(camera.metresPerUnit - 0.001) < 1e-12;
}

// A registered depth image is seen by the colour camera.
const char* depthFrame(const CameraInfo& camera) {
    return camera.registered && camera.hasColour ? kColourFrame : kDepthFrame;
}

} // namespace

uint64_t messageTime(double stamp) {
    constexpr double kMax = 2147483647.0; // [s] of a signed 32-bit number
    if (!(stamp >= 0.0 && stamp < kMax)) {
        throw BadInput("convert", "stamp", std::to_string(stamp) + " s", "0 to 2147483647 s for MCAP");
    }
    const double whole = std::floor(stamp);
    return static_cast<uint64_t>(whole) * 1'000'000'000 +
           static_cast<uint64_t>(std::llround(1e9 * (stamp - whole)));
}

McapRecording::McapRecording(const std::filesystem::path& file, const CameraInfo& camera)
    : camera_(writable(file, camera))
    , writer_(file) {
    const bool aligned = camera.registered && camera.hasColour;
    const std::string depth = aligned ? "/camera/aligned_depth_to_color/" : "/camera/depth/";
    depth_ = channel(depth + "image_raw", kImage);
    depthInfo_ = channel(depth + "camera_info", kInfo);
    if (camera.hasColour) {
        colour_ = channel("/camera/color/image_raw", kImage);
        colourInfo_ = channel("/camera/color/camera_info", kInfo);
    }
}

void McapRecording::addReplay(const std::filesystem::path& folder, uint32_t sourceFrames) {
    replay_.emplace(folder, writer_, sourceFrames);
}

uint16_t McapRecording::channel(const std::string& topic, const std::string& type) {
    return writer_.addChannel(topic, type, ros2::definition(type));
}

void McapRecording::addDepth(const Frame& frame, uint64_t time) {
    const Intrinsics& lens = camera_.depth;
    const ros2::Header header{time, depthFrame(camera_)};
    const std::span<const uint16_t> raw = frame->depth.first(lens.pixels());
    ros2::ImageData data{lens.width,
                         lens.height,
                         2,
                         "16UC1",
                         {reinterpret_cast<const uint8_t*>(raw.data()), raw.size_bytes()}};
    if (!inMillimetres(camera_)) {
        bytes_.resize(size_t{4} * raw.size());
        for (size_t i = 0; i < raw.size(); ++i) {
            const float metres = raw[i] == 0 ? NAN : static_cast<float>(raw[i] * camera_.metresPerUnit);
            std::memcpy(bytes_.data() + 4 * i, &metres, sizeof metres);
        }
        data = {lens.width, lens.height, 4, "32FC1", bytes_};
    }
    writer_.add(depth_, time, ros2::image(header, data));
    writer_.add(depthInfo_, time, ros2::cameraInfo(header, lens));
}

void McapRecording::addColour(const Frame& frame, uint64_t time) {
    const Intrinsics& lens = camera_.colour;
    const ros2::Header header{time, kColourFrame};
    readColours(*frame, colours_);
    bytes_.clear();
    for (const uint32_t rgba : colours_) {
        bytes_.insert(bytes_.end(), {static_cast<uint8_t>(rgba), static_cast<uint8_t>(rgba >> 8),
                                     static_cast<uint8_t>(rgba >> 16)});
    }
    writer_.add(colour_, time, ros2::image(header, {lens.width, lens.height, 3, "rgb8", bytes_}));
    writer_.add(colourInfo_, time, ros2::cameraInfo(header, lens));
}

void McapRecording::addPoses(const Frame& frame, uint64_t time) {
    if (!placed_ && camera_.hasColour && !camera_.registered) {
        placed_ = true;
        tfStatic_ = channel("/tf_static", kTransforms);
        writer_.add(*tfStatic_, time,
                    ros2::transform({time, ""}, {kDepthFrame, kColourFrame, inverse(camera_.colourTdepth)}));
    }
    if (frame->baseTcamera) {
        tf_ = tf_ ? tf_ : std::optional(channel("/tf", kTransforms));
        writer_.add(*tf_, time,
                    ros2::transform({time, ""}, {"base", depthFrame(camera_), *frame->baseTcamera}));
    }
}

void McapRecording::add(const Frame& frame) {
    const uint64_t time = messageTime(frame->captureTime);
    if (replay_) {
        replay_->frame(frame->index, frame->captureTime);
    }
    addPoses(frame, time);
    addDepth(frame, time);
    if (camera_.hasColour) {
        addColour(frame, time);
    }
}

void McapRecording::finish() {
    if (replay_) {
        replay_->end();
    }
    writer_.finish();
}

} // namespace fathom
