// SPDX-License-Identifier: Apache-2.0
// Camera that plays a ROS 1 bag once: one recorded by a RealSense, or any with depth, colour and camera_info
// topics.
#pragma once

#include "devices/bag/bag_file.h"
#include "devices/camera.h"
#include "devices/frame_slots.h"

#include <optional>

namespace fathom {

// Plays the first depth topic and the first colour topic, each with its camera_info. Frame index
// and source number = message of the depth topic from 0, capture time = its header's stamp. A depth image is
// paired with the colour image nearest in time, at most half the slower stream's period away (a colour image
// may be used twice); an unpaired or damaged one is skipped, counted and logged. Depth and colour are
// registered when the topic or a shared lens says so; otherwise the bag must have RealSense's extrinsics
// (topic .../tf/0).
class BagCamera final : public Camera {
public:
    // Throws BadInput naming the file and the topic.
    explicit BagCamera(const std::filesystem::path& file);

    const CameraInfo& info() const override { return info_; }
    std::optional<Frame> next() override;
    uint32_t skipped() const override { return skipped_; }
    std::string description() const override { return "bag " + bag_.file().string(); }

private:
    struct Stream {
        const BagTopic* topic = nullptr;
        std::string frame, encoding;
        std::vector<double> stamps; // [s] when each message was recorded
    };
    void chooseTopics();
    std::optional<Stream> openStream(const BagTopic& topic, bool (*wanted)(const std::string&));
    void readLenses();
    Intrinsics lensOf(const Stream& stream);
    Pose tfOf(const Stream& stream);
    double depthUnit();
    double tolerance() const;
    std::optional<size_t> colourFor(double stamp) const;
    std::string read(size_t index, FrameSlot& slot, double& stamp);

    BagFile bag_;
    CameraInfo info_;
    Stream depth_;
    std::optional<Stream> colour_;
    std::optional<FrameSlots> slots_;
    double tolerance_ = 0.0; // [s]
    uint32_t cursor_ = 0, skipped_ = 0;
    bool delivered_ = false;
    std::string firstFault_;
};

} // namespace fathom
