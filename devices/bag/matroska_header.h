// SPDX-License-Identifier: Apache-2.0
// What a Matroska file states beside its blocks: tracks, tags and attached files. Source: RFC 9559, and
// Azure-Kinect-Sensor-SDK 8bb59caa, src/record.
#pragma once

#include "devices/bag/ebml_reader.h"

#include <map>

namespace fathom {

// IDs of elements.
enum class Matroska : uint32_t {
    Head = 0x1A45DFA3,
    Segment = 0x18538067,
    Info = 0x1549A966,
    Tracks = 0x1654AE6B,
    Tags = 0x1254C367,
    Attachments = 0x1941A469,
    Cluster = 0x1F43B675,
    Cues = 0x1C53BB6B,
    SeekHead = 0x114D9B74,
    Chapters = 0x1043A770,
    Timestamp = 0xE7,
    SimpleBlock = 0xA3,
    BlockGroup = 0xA0,
    Block = 0xA1,
    Void = 0xEC,
    Checksum = 0xBF,
    Position = 0xA7,
    PreviousSize = 0xAB,
    SilentTracks = 0x5854,
};
inline bool is(const EbmlElement& element, Matroska id) {
    return element.id == static_cast<uint32_t>(id);
}

// One track. Video where it has a size.
struct MatroskaTrack {
    uint64_t number = 0, uid = 0;
    std::string name, codec;
    uint64_t width = 0, height = 0; // [pixels]
    std::string fourcc;             // of uncompressed images
    bool encoded = false;           // its blocks are compressed or encrypted
};

// Throws Error when an element is damaged, or there is more than a recording can need.
class MatroskaHeader {
public:
    explicit MatroskaHeader(FileBytes& file)
        : reader_(file) {}

    void readInfo(const EbmlElement& info);
    void readTracks(const EbmlElement& tracks);
    void readTags(const EbmlElement& tags);
    void readAttachments(const EbmlElement& attachments);

    uint64_t timescale() const { return timescale_; } // [ns] per unit of time
    const std::vector<MatroskaTrack>& tracks() const { return tracks_; }
    // Empty when there is no such tag.
    std::string tag(const std::string& name) const;
    // A number; 0 when there is none.
    int64_t numberTag(const std::string& name) const;
    // The attached file; empty when there is none.
    std::vector<uint8_t> attachment(const std::string& name) const;

private:
    MatroskaTrack track(const EbmlElement& entry);
    void readVideo(const EbmlElement& video, MatroskaTrack& track);

    EbmlReader reader_;
    uint64_t timescale_ = 1'000'000;
    std::vector<MatroskaTrack> tracks_;
    std::map<std::string, std::string> tags_;
    std::map<std::string, std::vector<uint8_t>> attachments_;
};

} // namespace fathom
