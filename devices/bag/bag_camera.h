// SPDX-License-Identifier: Apache-2.0
// Camera that plays a file of messages once: a ROS bag recorded by a RealSense, or any with depth, colour and
// camera_info topics.
#pragma once

#include "devices/bag/message_file.h"
#include "devices/bag/stamped_stream.h"
#include "devices/bag/stream_choice.h"
#include "devices/camera.h"
#include "devices/frame_slots.h"

#include <optional>

namespace fathom {

// Plays the streams that StreamChooser chooses. Frame index and source number = message of the depth topic
// from 0, capture time = its header's stamp. A depth image is paired with the colour image whose header's
// stamp is nearest, at most half the slower stream's period away (a colour image may be used twice); by the
// time of recording, with a warning, where no stamps are that near. An unpaired or damaged image, and one
// whose stamp goes back, is skipped, counted and logged.
class BagCamera final : public Camera {
public:
    // Throws BadInput naming the file and the topic.
    explicit BagCamera(const std::filesystem::path& file, SourceOptions options = {});
    BagCamera(std::unique_ptr<MessageFile> file, SourceOptions options);

    const CameraInfo& info() const override { return choice_.camera; }
    std::optional<Frame> next() override;
    uint32_t skipped() const override { return skipped_; }
    uint32_t images() const override { return end_; }
    bool seek(uint32_t index) override;
    std::string description() const override { return "bag " + file_->file().string(); }
    std::string streams() const override { return choice_.said; }
    std::string streamOptions() const override;
    std::string whyNoColour() const override;

private:
    using Image = ros::Image;
    void useSpan();
    void useClocks();
    bool pairsByStamp();
    void chooseUnit();
    double sensorUnit();
    double farthestSampled();
    Image imageOf(const ImageStream& stream, size_t index);
    std::string read(size_t index, FrameSlot& slot, double stamp);
    std::string readColour(size_t depthIndex, double stamp, FrameSlot& slot);
    void tellBeyond(size_t index, uint64_t beyond);
    Frame lease(size_t index, double stamp, FrameSlot& slot) const;
    const MessageTopic& topicOf(const ImageStream& stream) const { return file_->topics()[stream.topic]; }

    SourceOptions options_;
    std::unique_ptr<MessageFile> file_;
    StreamChoice choice_;
    std::optional<StampedStream> depth_, colour_;
    std::optional<FrameSlots> slots_;
    double valuesPerUnit_ = 1.0; // of depth in metres
    double tolerance_ = 0.0;     // [s]
    uint32_t cursor_ = 0, end_ = 0, skipped_ = 0;
    bool delivered_ = false, toldBeyond_ = false;
    std::optional<double> lastStamp_; // [s] of the last delivered frame
    std::string firstFault_;
};

} // namespace fathom
