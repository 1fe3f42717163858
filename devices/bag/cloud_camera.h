// SPDX-License-Identifier: Apache-2.0
// Camera that plays the organised clouds of a file of messages: depth images and lens follow from the points.
#pragma once

#include "devices/bag/cloud_message.h"
#include "devices/bag/message_camera.h"
#include "devices/pcd/pcd_camera.h"

namespace fathom {

// Whether a file of messages is played by its clouds: depth=TOPIC names one, or no image is depth.
bool playsClouds(MessageFile& file, const SourceOptions& options);

// Lens and axes are those of the first cloud that shows them (fitLens()); a later one that deviates by over a
// pixel is skipped, counted and logged.
class CloudCamera final : public MessageCamera {
public:
    // Throws BadInput naming file and topic.
    CloudCamera(std::unique_ptr<MessageFile> file, SourceOptions options);

    const CameraInfo& info() const override { return info_; }
    std::string description() const override { return "clouds of " + file_->file().string(); }
    std::string streams() const override { return summary_; }
    std::string streamOptions() const override { return ",depth=" + topic().name; }
    std::string whyNoColour() const override { return info_.hasColour ? "" : uncoloured_; }

private:
    [[noreturn]] void refuse(const std::string& field, const std::string& value,
                             const std::string& allowed) const;
    void checkOptions() const;
    void chooseTopic();
    std::string fit(const ros::Cloud& message, const PcdCloud& cloud);
    void judgeOrder();
    void learnLens();
    const MessageTopic& topic() const { return file_->topics()[topic_]; }
    ros::Cloud cloudAt(size_t index) {
        ros::Cloud cloud = ros::cloud(file_->read(topic(), index));
        warnOnce(topic().name, cloud.stepFault);
        cloud.bigEndian = bigEndian_.value_or(cloud.bigEndian);
        return cloud;
    }
    std::string read(size_t index, FrameSlot& slot, double stamp, Frame::Content& content) override;

    size_t topic_ = 0;
    std::string summary_;
    CameraInfo info_;
    FittedLens fit_;
    std::optional<bool> bigEndian_;                     // where its messages state the other order
    std::string frame_;                                 // of the cloud with that lens
    std::string uncoloured_ = "no colour is asked for"; // why there is none
    double metresPerValue_ = 1.0;
    double largestLevel_ = 0.0; // of colours (ColourFields::read())
};

} // namespace fathom
