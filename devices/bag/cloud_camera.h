// SPDX-License-Identifier: Apache-2.0
// Camera that plays the organised clouds of a file of messages: depth images and lens follow from the points.
#pragma once

#include "devices/bag/cloud_message.h"
#include "devices/bag/message_file.h"
#include "devices/bag/stamped_stream.h"
#include "devices/camera.h"
#include "devices/frame_slots.h"
#include "devices/pcd/pcd_camera.h"
#include "devices/recorded/source_options.h"

#include <optional>

namespace fathom {

// Whether a file of messages is played by its clouds: depth=TOPIC names one, or no image is depth.
bool playsClouds(MessageFile& file, const SourceOptions& options);

// Lens and axes are those of the first cloud that shows them (fitLens()); a later one that deviates by over a
// pixel is skipped, counted and logged, as damaged ones and stamps that go back are. Frame index and source
// number = message of the topic from 0, capture time = its header's stamp.
class CloudCamera final : public Camera {
public:
    // Throws BadInput naming file and topic.
    CloudCamera(std::unique_ptr<MessageFile> file, SourceOptions options);

    const CameraInfo& info() const override { return info_; }
    std::optional<Frame> next() override;
    uint32_t skipped() const override { return skipped_; }
    uint32_t images() const override { return end_; }
    bool seek(uint32_t index) override;
    std::string description() const override { return "clouds of " + file_->file().string(); }
    std::string streams() const override { return said_; }
    std::string streamOptions() const override { return ",depth=" + topic().name; }
    std::string whyNoColour() const override { return info_.hasColour ? "" : "the clouds have no field rgb"; }

private:
    [[noreturn]] void refuse(const std::string& field, const std::string& value,
                             const std::string& allowed) const;
    void checkOptions() const;
    void chooseTopic();
    void useSpan();
    std::string fit(const ros::Cloud& message, const PcdCloud& cloud);
    void learnLens();
    const MessageTopic& topic() const { return file_->topics()[topic_]; }
    ros::Cloud cloudAt(size_t index) { return ros::cloud(file_->read(topic(), index)); }
    std::string read(size_t index, FrameSlot& slot, double stamp);

    SourceOptions options_;
    std::unique_ptr<MessageFile> file_;
    size_t topic_ = 0;
    std::string said_;
    CameraInfo info_;
    FittedLens fit_;
    double metresPerValue_ = 1.0;
    std::optional<StampedStream> stamps_;
    std::optional<FrameSlots> slots_;
    uint32_t cursor_ = 0, end_ = 0, skipped_ = 0;
    bool delivered_ = false;
    std::optional<double> lastStamp_; // [s]
    std::string firstFault_;
};

} // namespace fathom
