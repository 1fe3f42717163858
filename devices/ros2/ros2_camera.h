// SPDX-License-Identifier: Apache-2.0
// A live camera whose images are topics of a ROS 2 graph.
#pragma once

#include "devices/bag/stream_choice.h"
#include "devices/camera.h"
#include "devices/frame_slots.h"
#include "devices/recorded/range_images.h"
#include "devices/ros2/first_publisher.h"
#include "devices/ros2/live_pairs.h"
#include "devices/ros2/live_stamps.h"
#include "devices/ros2/moving_camera.h"
#include "devices/ros2/newest_messages.h"
#include "devices/ros2/ros2_graph.h"
#include "devices/ros2/ros2_request.h"
#include "devices/skipped_frames.h"

#include <optional>
#include <string>
#include <vector>

namespace fathom {

// Subscribes images with the QoS of sensors. A topic ".../compressed" or ".../compressedDepth" holds
// sensor_msgs/msg/CompressedImage, every other one sensor_msgs/msg/Image. Lens, registration and extrinsics
// are found as in a recording (StreamChooser), from camera_info, tf_static and extrinsics/depth_to_color.
//
// Frame index and source number count delivered frames from 0 and 1. Images are paired by their stamps
// (LivePairs); capture times are CLOCK_MONOTONIC (LiveStamps). An unusable message is skipped and counted,
// and each cause is logged once. If the request names a frame, frames have the pose that tf gives at the
// stamp of their depth (MovingCamera); those without one are skipped. Messages of a second publisher of a
// topic are ignored while the first one sends. next() throws DeviceLost when no depth image, or no usable
// one, came for `silence`; the subscription remains, so the next call finds the camera again.
class Ros2Camera final : public Camera {
public:
    // Waits for the first images and their lens. Throws BadInput that says what is missing.
    explicit Ros2Camera(const Ros2Request& request);

    const CameraInfo& info() const override { return choice_.camera; }
    std::optional<Frame> next() override;
    uint32_t skipped() const override { return skipped_.count(); }
    std::vector<std::string> warnings() const override { return skipped_.causes(); }
    bool live() const override { return true; }
    uint64_t lost() const override { return overtaken_ + inbox_.lost(depth_.place); }
    std::string streams() const override { return choice_.summary; }
    std::string description() const override { return "ros2 " + request_.options.depth; }

    uint64_t foreign() const { // messages of second publishers
        return depth_.publisher->foreign() + (colour_.publisher ? colour_.publisher->foreign() : 0);
    }

private:
    struct Topic {
        size_t place = 0; // in the inbox and in messages_
        bool compressed = false;
        std::optional<FirstPublisher> publisher = {};
    };
    Topic subscribeImages(const std::string& topic);
    void subscribeOthers();
    void awaitStreams();
    void logWarnings() const;
    bool gather();
    void chooseUnit();
    void receive();
    void receive(Topic& topic, const ImageStream& stream, LiveStamps& stamps, bool depth);
    ros::Image imageOf(const ImageStream& stream, const RawMessage& message) const;
    void receiveTransforms();
    std::optional<MovingCamera::Posed> nextPosed(double now);
    std::optional<MovingCamera::Posed> choose(double now);
    std::optional<Frame> deliver();
    std::string fill(const LivePairs::Pair& pair, FrameSlot& slot, RawColour& raw);
    std::string fillDepth(const RawMessage& message, FrameSlot& slot);
    std::string fillColour(const RawMessage& message, FrameSlot& slot, RawColour& raw);
    void skip(const std::string& fault, uint32_t frames = 1);
    std::string missing(const std::string& why) const;

    Ros2Request request_;
    std::shared_ptr<Ros2Graph> graph_;
    Ros2Inbox inbox_;
    NewestMessages messages_;
    Topic depth_, colour_;
    std::optional<MovingCamera> moving_; // none: the scene gives the pose
    size_t tf_ = 0, tfStatic_ = 0;       // topics, as Topic::place
    StreamChoice choice_;
    std::optional<LivePairs> pairs_;
    std::optional<LiveStamps> depthStamps_, colourStamps_;
    std::optional<FrameSlots> slots_;
    RangeToAxis toAxis_;
    std::optional<bool> bigEndian_; // of depth, where its messages state the other order
    double valuesPerUnit_ = 1.0;    // of depth in metres
    double lastDepth_ = 0.0; // [s] CLOCK_MONOTONIC, arrival of the newest depth image; at first: when opened
    uint32_t delivered_ = 0;
    uint64_t overtaken_ = 0;
    SkippedFrames skipped_;
};

} // namespace fathom
