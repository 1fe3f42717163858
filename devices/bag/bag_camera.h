// SPDX-License-Identifier: Apache-2.0
// Camera that plays a file of messages once: a ROS bag recorded by a RealSense, or any with depth, colour and
// camera_info topics.
#pragma once

#include "devices/bag/changed_messages.h"
#include "devices/bag/message_camera.h"
#include "devices/bag/stream_choice.h"
#include "devices/recorded/range_images.h"

#include <functional>
#include <optional>

namespace fathom {

// Plays the streams that StreamChooser chooses. A depth image is paired with the colour image whose header's
// stamp is nearest, at most half the slower stream's period away (a colour image may be used twice); by the
// time of recording, with a warning, where no stamps are that near, or where images far from each other in
// the file would be paired whose stamps do not agree. An unpaired image is skipped, counted and logged.
class BagCamera final : public MessageCamera {
public:
    // Throws BadInput naming the file and the topic.
    explicit BagCamera(const std::filesystem::path& file, SourceOptions options = {});
    BagCamera(std::unique_ptr<MessageFile> file, SourceOptions options);

    const CameraInfo& info() const override { return choice_.camera; }
    std::string description() const override { return "bag " + file_->file().string(); }
    std::string streams() const override { return choice_.summary; }
    std::string streamOptions() const override;
    std::string whyNoColour() const override;

private:
    using Image = ros::Image;
    void logWarnings();
    void useClocks();
    bool pairsByStamp();
    bool stampsAgree();
    bool anyOfSome(const std::function<bool(size_t)>& holds) const;
    void judgeOrder();
    void chooseUnit();
    const MessageTopic* unitTopic() const;
    double sensorUnit();
    void warnOfUnit(const std::string& warning); // nothing if empty
    void watchChanges();
    std::string changed(uint64_t time);
    ValueSpan sampledMetres();
    Image imageOf(const ImageStream& stream, size_t index);
    Image depthAt(size_t index);
    std::string read(size_t index, FrameSlot& slot, double stamp, Frame::Content& content) override;
    std::string readColour(size_t depthIndex, double stamp, FrameSlot& slot, RawColour& raw);
    const MessageTopic& topicOf(const ImageStream& stream) const { return file_->topics()[stream.topic]; }

    StreamChoice choice_;
    std::optional<StampedStream> colour_;
    std::optional<ChangedMessages> units_, depthLenses_, colourLenses_; // only where there may be several
    RangeToAxis toAxis_;
    std::optional<bool> bigEndian_; // of depth, where its messages state the other order
    double valuesPerUnit_ = 1.0;    // of depth in metres
    double tolerance_ = 0.0;        // [s]
};

} // namespace fathom
