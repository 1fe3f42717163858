// SPDX-License-Identifier: Apache-2.0
#include "devices/bag/matroska_file.h"

#include "devices/bag/byte_cursor.h"
#include "devices/bag/kinect_calibration.h"
#include "devices/bag/ros2_messages.h"
#include "engine/types/log.h"
#include "engine/types/read_file.h"

#include <algorithm>
#include <array>

namespace fathom {

namespace {

constexpr uint64_t kMaxBlocks = 20'000'000, kMaxImage = 1 << 27; // [bytes]
constexpr uint64_t kSecond = 1'000'000'000;                      // [ns]
constexpr uint64_t kMaxTime = kSecond * UINT32_MAX;              // of a header's stamp
constexpr uint64_t kMadeMessage = UINT64_MAX;                    // as chunk
constexpr unsigned kSizeBits = 32;
constexpr const char* kCalibrationName = "calibration.json";

// Elements between clusters.
bool isTopLevel(const EbmlElement& element) {
    return is(element, Matroska::Cluster) || is(element, Matroska::Cues) || is(element, Matroska::Tags) ||
           is(element, Matroska::Info) || is(element, Matroska::Tracks) || is(element, Matroska::SeekHead) ||
           is(element, Matroska::Attachments) || is(element, Matroska::Chapters);
}

// Elements without images that may be anywhere, or only in clusters.
bool isFiller(const EbmlElement& element) {
    return is(element, Matroska::Void) || is(element, Matroska::Checksum) ||
           is(element, Matroska::Position) || is(element, Matroska::PreviousSize) ||
           is(element, Matroska::SilentTracks);
}

} // namespace

MatroskaFile::MatroskaFile(const std::filesystem::path& file)
    : MessageFile(file)
    , data_(file)
    , reader_(data_)
    , head_(data_) {
    if (!data_.open()) {
        throw BadInput(file.string(), "file", whyUnreadable(file), "a Matroska file (.mkv)");
    }
    try {
        data_.readAhead(false); // the images are not read yet
        readSegment();
        data_.readAhead(true);
        makeTopics();
        addCalibration();
    } catch (const BadInput&) {
        throw;
    } catch (const Error& e) {
        throw BadInput(file.string(), "content", e.what(), "a Matroska file (.mkv), whole");
    }
    if (damaged_ > 1) {
        log::warn("{}: {} damaged places", file.string(), damaged_);
    }
}

void MatroskaFile::readSegment() {
    const EbmlElement head = reader_.element(0, data_.size());
    if (!is(head, Matroska::Head)) {
        throw Error("no Matroska header");
    }
    // A file that was not finished, or was cut, has a segment that ends elsewhere.
    EbmlElement segment = reader_.element(head.end, UINT64_MAX);
    if (!is(segment, Matroska::Segment)) {
        throw Error("no segment");
    }
    segment.end = std::min(segment.end, data_.size());
    for (uint64_t at = segment.dataAt; at < segment.end;) {
        try {
            at = readChild(reader_.cutElement(at, segment.end));
        } catch (const Error& e) {
            if (head_.tracks().empty()) {
                throw;
            }
            logDamaged(at, e);
            at = nextCluster(at + 1);
        }
    }
}

// Returns where the next element begins.
uint64_t MatroskaFile::readChild(const EbmlElement& child) {
    if (is(child, Matroska::Cluster)) {
        return readCluster(child);
    }
    if (!child.sized || (!isTopLevel(child) && !isFiller(child))) { // its size would hide clusters
        throw Error("an unknown element, or one without its end");
    }
    if (is(child, Matroska::Info)) {
        head_.readInfo(child);
    } else if (is(child, Matroska::Tracks)) {
        head_.readTracks(child);
    } else if (is(child, Matroska::Tags)) {
        head_.readTags(child);
    } else if (is(child, Matroska::Attachments)) {
        head_.readAttachments(child);
    }
    return child.end;
}

uint64_t MatroskaFile::readCluster(const EbmlElement& cluster) {
    uint64_t time = 0, at = cluster.dataAt;
    try {
        while (at < cluster.end) {
            const EbmlElement child = reader_.element(at, cluster.end);
            if (isTopLevel(child)) {
                return at; // the cluster has no size, or a damaged one
            }
            if (is(child, Matroska::Timestamp)) {
                time = reader_.number(child);
            } else if (is(child, Matroska::SimpleBlock)) {
                readBlock(child, time);
            } else if (is(child, Matroska::BlockGroup)) {
                reader_.children(child, [&](const EbmlElement& part) {
                    if (is(part, Matroska::Block)) {
                        readBlock(part, time);
                    }
                });
            } else if (!isFiller(child)) {
                throw Error("an unknown element");
            }
            at = child.end;
        }
    } catch (const Error& e) {
        logDamaged(at, e);
        return cluster.sized ? cluster.end : nextCluster(at + 1);
    }
    return at;
}

// Track, time relative to the cluster's and flags, then the data of one image.
void MatroskaFile::readBlock(const EbmlElement& block, uint64_t clusterTime) {
    constexpr uint64_t kMaxHeader = 12;
    constexpr uint8_t kLaced = 0x06;
    const EbmlElement start{block.id, block.dataAt, std::min(block.end, block.dataAt + kMaxHeader), true};
    const std::vector<uint8_t> head = reader_.bytes(start, kMaxHeader);
    const auto [track, length] = ebmlNumber(head);
    ByteCursor cursor(std::span<const uint8_t>(head).subspan(length));
    const uint16_t high = cursor.value<uint8_t>();
    const auto relative = static_cast<int16_t>(high << 8 | cursor.value<uint8_t>());
    const bool laced = (cursor.value<uint8_t>() & kLaced) != 0;
    if (laced && cursor.value<uint8_t>() != 0) {
        return; // several in one: samples of other sensors
    }
    const uint64_t dataAt = block.dataAt + head.size() - cursor.left(), size = block.end - dataAt;
    if (clusterTime > kMaxTime / head_.timescale()) {
        throw Error("a time of " + std::to_string(clusterTime));
    }
    const int64_t time =
        (static_cast<int64_t>(clusterTime) + relative) * static_cast<int64_t>(head_.timescale());
    if (size > kMaxImage || ++count_ > kMaxBlocks) {
        throw Error("an image of " + std::to_string(size) + " bytes, or over " + std::to_string(kMaxBlocks));
    }
    blocks_[track].push_back({static_cast<uint64_t>(std::max<int64_t>(0, time)), size, dataAt});
}

// The first cluster that begins at `from` or behind; the file's end when there is none.
uint64_t MatroskaFile::nextCluster(uint64_t from) {
    constexpr size_t kBlock = 1 << 16;
    constexpr std::array<uint8_t, 4> kId{0x1F, 0x43, 0xB6, 0x75};
    std::vector<uint8_t> bytes;
    while (from + kId.size() <= data_.size()) {
        bytes.resize(std::min<uint64_t>(kBlock, data_.size() - from));
        data_.read(from, bytes);
        const auto found = std::search(bytes.begin(), bytes.end(), kId.begin(), kId.end());
        if (found != bytes.end()) {
            return from + static_cast<uint64_t>(found - bytes.begin());
        }
        from += bytes.size() - (kId.size() - 1);
    }
    return data_.size();
}

void MatroskaFile::logDamaged(uint64_t at, const Error& why) {
    if (++damaged_ == 1) {
        log::warn("{}: damaged at byte {}: {}; the rest of its cluster is skipped", file().string(), at,
                  why.what());
    }
}

// By the tags of the recorder, else the track's own name.
std::string MatroskaFile::nameOf(const MatroskaTrack& track) const {
    for (const char* name : {"COLOR", "DEPTH", "IR"}) {
        if (track.uid != 0 && head_.tag("K4A_" + std::string(name) + "_TRACK") == std::to_string(track.uid)) {
            return name;
        }
    }
    return track.name.empty() ? "track " + std::to_string(track.number) : track.name;
}

void MatroskaFile::makeTopics() {
    if (head_.tracks().empty()) {
        throw Error("no tracks");
    }
    for (const MatroskaTrack& track : head_.tracks()) {
        addTrack(track);
    }
    blocks_.clear();
    sortByTime();
}

void MatroskaFile::addTrack(const MatroskaTrack& track) {
    const MatroskaImages images(track, nameOf(track));
    const std::string other = track.codec + (track.fourcc.empty() ? "" : " " + track.fourcc) +
                              (track.encoded ? " (encoded)" : "") + (track.width > 0 ? " Video" : "");
    const size_t at = topicAt(images.name, images.encoding.empty() ? other : "sensor_msgs/Image", false);
    // The depth image is taken later than the colour image by as much.
    const int64_t later = images.name == "COLOR" ? head_.numberTag("K4A_DEPTH_DELAY_NS") : 0;
    const double shift =
        static_cast<double>(head_.numberTag("K4A_START_OFFSET_NS")) + static_cast<double>(later);
    for (MessageEntry entry : blocks_[track.number]) {
        const double time = static_cast<double>(entry.time) + shift;
        entry.time = static_cast<uint64_t>(std::clamp(time, 0.0, static_cast<double>(kMaxTime)));
        entry.chunk |= uint64_t{tracks_.size()} << kSizeBits;
        topics_[at].messages.push_back(entry);
    }
    tracks_.push_back(images);
}

void MatroskaFile::addMade(const std::string& topic, const std::string& type, std::vector<uint8_t> message) {
    MessageTopic& added = topics_[topicAt(topic, type, true)];
    added = {topic, type, {{0, kMadeMessage, made_.size()}}, true};
    made_.push_back(std::move(message));
}

void MatroskaFile::addCalibration() {
    const std::string tagged = head_.tag("K4A_CALIBRATION_FILE");
    const std::vector<uint8_t> json = head_.attachment(tagged.empty() ? kCalibrationName : tagged);
    if (json.empty()) {
        for (const char* name : {"DEPTH/camera_info", "COLOR/camera_info"}) {
            faults_[name] = std::string("no attached ") + kCalibrationName;
        }
        return;
    }
    const KinectCalibration calibration(json, file().string() + ": " + kCalibrationName);
    for (const MatroskaImages& images : tracks_) {
        addLens(images, calibration);
    }
    addMade("extrinsics/depth_to_color", "realsense2_camera_msgs/Extrinsics",
            ros2::extrinsics(calibration.colourTdepth()));
}

void MatroskaFile::addLens(const MatroskaImages& images, const KinectCalibration& calibration) {
    const bool colour = images.name == "COLOR";
    if (images.encoding.empty() || (!colour && images.name != "DEPTH" && images.name != "IR")) {
        return;
    }
    const std::string topic = images.name + "/camera_info";
    try {
        addMade(topic, "sensor_msgs/CameraInfo",
                ros2::cameraInfo({}, colour ? calibration.colour(images.width, images.height)
                                            : calibration.depth(images.width, images.height)));
    } catch (const Error& e) {
        faults_[topic] = e.what();
    }
}

MessageBytes MatroskaFile::bytes(const MessageEntry& entry) {
    if (entry.chunk == kMadeMessage) {
        return {made_[entry.offset], nullptr};
    }
    const uint64_t size = entry.chunk & ((uint64_t{1} << kSizeBits) - 1);
    return MessageBytes::of(
        tracks_[entry.chunk >> kSizeBits].message(entry.time, data_.read(entry.offset, size, kMaxImage)));
}

} // namespace fathom
