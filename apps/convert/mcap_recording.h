// SPDX-License-Identifier: Apache-2.0
// An MCAP file with messages of ROS 2 that Foxglove and Fathom read.
#pragma once

#include "apps/convert/frame_sink.h"
#include "apps/convert/replay_topics.h"
#include "devices/bag/mcap_writer.h"
#include "engine/types/camera_info.h"

#include <optional>

namespace fathom {

// Topics /camera/{depth,color}/{image_raw,camera_info}, registered depth as /camera/aligned_depth_to_color,
// and /tf, /tf_static where poses are known. Depth in millimetres stays 16UC1; of any other unit it becomes
// 32FC1 in metres. Colour is rgb8. With a replay: the topics of ReplayTopics. One thread.
class McapRecording final : public FrameSink {
public:
    // Throws BadInput for a lens that CameraInfo does not hold.
    McapRecording(const std::filesystem::path& file, const CameraInfo& camera);
    // Call before the first frame. See ReplayTopics.
    void addReplay(const std::filesystem::path& folder, uint32_t sourceFrames);

    // Throws BadInput for a stamp that ROS does not hold.
    void add(const Frame& frame) override;
    void finish() override;

private:
    uint16_t channel(const std::string& topic, const std::string& type);
    void addDepth(const Frame& frame, uint64_t time);
    void addColour(const Frame& frame, uint64_t time);
    void addPoses(const Frame& frame, uint64_t time);

    CameraInfo camera_;
    McapWriter writer_;
    uint16_t depth_ = 0, depthInfo_ = 0, colour_ = 0, colourInfo_ = 0;
    std::optional<uint16_t> tf_, tfStatic_;
    bool placed_ = false; // the colour camera's pose is written
    std::optional<ReplayTopics> replay_;
    std::vector<uint32_t> colours_;
    std::vector<uint8_t> bytes_;
};

} // namespace fathom
