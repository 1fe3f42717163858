// SPDX-License-Identifier: Apache-2.0
// A recording of an Azure Kinect or Femto (k4arecorder) in a Matroska file, .mkv. Read without libmatroska,
// whose stack 2 MB of nested tags exhaust.
#pragma once

#include "devices/bag/matroska_images.h"
#include "devices/bag/message_file.h"

namespace fathom {

class KinectCalibration;

// Its tracks are topics, the images of COLOR, DEPTH and IR sensor_msgs/Image. The calibration gives lenses
// and the pose from depth to colour as topics, too. One thread.
class MatroskaFile final : public MessageFile {
public:
    // Throws BadInput that names the file: not Matroska, no track, or a damaged header. A damaged cluster is
    // skipped and named in the log.
    explicit MatroskaFile(const std::filesystem::path& file);
    MessageBytes bytes(const MessageEntry& entry) override;

private:
    void readSegment();
    uint64_t readChild(const EbmlElement& child);
    uint64_t readCluster(const EbmlElement& cluster);
    void readBlock(const EbmlElement& block, uint64_t clusterTime);
    uint64_t nextCluster(uint64_t from);
    void logDamaged(uint64_t at, const Error& why);
    void makeTopics();
    std::string nameOf(const MatroskaTrack& track) const;
    void addTrack(const MatroskaTrack& track);
    void addCalibration();
    void addLens(const MatroskaImages& images, const KinectCalibration& calibration);
    void addMade(const std::string& topic, const std::string& type, std::vector<uint8_t> message);

    FileBytes data_;
    EbmlReader reader_;
    MatroskaHeader head_;
    std::map<uint64_t, std::vector<MessageEntry>> blocks_; // by the track's number, until topics are made
    uint64_t count_ = 0, damaged_ = 0;                     // blocks, damaged places
    std::vector<MatroskaImages> tracks_; // a message's chunk is the place here, and the size of its data
    std::vector<std::vector<uint8_t>> made_;
};

} // namespace fathom
