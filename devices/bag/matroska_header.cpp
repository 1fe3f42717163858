// SPDX-License-Identifier: Apache-2.0
#include "devices/bag/matroska_header.h"

#include "engine/types/parse_number.h"

namespace fathom {

namespace {

constexpr uint64_t kMaxWords = 4096, kMaxPrivate = 1 << 16, kMaxAttached = 1 << 24; // [bytes]
constexpr size_t kMaxTracks = 64, kMaxTags = 10'000, kMaxFiles = 8;
constexpr uint64_t kMaxTimescale = 1'000'000'000; // [ns]

enum class Field : uint32_t {
    Timescale = 0x2AD7B1,
    TrackEntry = 0xAE,
    TrackNumber = 0xD7,
    TrackUid = 0x73C5,
    Name = 0x536E,
    Codec = 0x86,
    CodecPrivate = 0x63A2,
    Encodings = 0x6D80,
    Video = 0xE0,
    Width = 0xB0,
    Height = 0xBA,
    Fourcc = 0x2EB524,
    Tag = 0x7373,
    SimpleTag = 0x67C8,
    TagName = 0x45A3,
    TagText = 0x4487,
    AttachedFile = 0x61A7,
    FileName = 0x466E,
    FileData = 0x465C,
};

Field fieldOf(const EbmlElement& element) {
    return static_cast<Field>(element.id);
}

// biCompression of a BITMAPINFOHEADER.
std::string fourccOf(const std::vector<uint8_t>& header) {
    constexpr size_t kAt = 16, kSize = 4;
    return header.size() < kAt + kSize
               ? ""
               : printable(std::string(header.begin() + kAt, header.begin() + kAt + kSize));
}

void bound(size_t count, size_t most, const char* what) {
    if (count >= most) {
        throw Error(std::string("over ") + std::to_string(most) + " " + what);
    }
}

} // namespace

void MatroskaHeader::readInfo(const EbmlElement& info) {
    reader_.children(info, [&](const EbmlElement& child) {
        timescale_ = fieldOf(child) == Field::Timescale ? reader_.number(child) : timescale_;
    });
    if (timescale_ == 0 || timescale_ > kMaxTimescale) {
        throw Error("a unit of time of " + std::to_string(timescale_) + " ns (allowed: 1 to " +
                    std::to_string(kMaxTimescale) + ")");
    }
}

void MatroskaHeader::readTracks(const EbmlElement& tracks) {
    reader_.children(tracks, [&](const EbmlElement& child) {
        if (fieldOf(child) == Field::TrackEntry) {
            bound(tracks_.size(), kMaxTracks, "tracks");
            tracks_.push_back(track(child));
        }
    });
}

MatroskaTrack MatroskaHeader::track(const EbmlElement& entry) {
    MatroskaTrack track;
    std::vector<uint8_t> header;
    reader_.children(entry, [&](const EbmlElement& child) {
        switch (fieldOf(child)) {
        case Field::TrackNumber:
            track.number = reader_.number(child);
            break;
        case Field::TrackUid:
            track.uid = reader_.number(child);
            break;
        case Field::Name:
            track.name = reader_.text(child, kMaxWords);
            break;
        case Field::Codec:
            track.codec = reader_.text(child, kMaxWords);
            break;
        case Field::CodecPrivate:
            header = reader_.bytes(child, kMaxPrivate);
            break;
        case Field::Encodings:
            track.encoded = true;
            break;
        case Field::Video:
            readVideo(child, track);
            break;
        default:
            break;
        }
    });
    if (track.codec == "V_MS/VFW/FOURCC") {
        track.fourcc = fourccOf(header);
    } else if (track.codec == "V_MJPEG") {
        track.fourcc = "MJPG";
    }
    return track;
}

void MatroskaHeader::readVideo(const EbmlElement& video, MatroskaTrack& track) {
    reader_.children(video, [&](const EbmlElement& child) {
        if (fieldOf(child) == Field::Width) {
            track.width = reader_.number(child);
        } else if (fieldOf(child) == Field::Height) {
            track.height = reader_.number(child);
        } else if (fieldOf(child) == Field::Fourcc) {
            track.fourcc = reader_.text(child, kMaxWords);
        }
    });
}

// Of each tag its first name and text, as the SDK reads them.
void MatroskaHeader::readTags(const EbmlElement& tags) {
    reader_.children(tags, [&](const EbmlElement& tag) {
        if (fieldOf(tag) != Field::Tag) {
            return;
        }
        reader_.children(tag, [&](const EbmlElement& simple) {
            if (fieldOf(simple) != Field::SimpleTag) {
                return;
            }
            std::string name, text;
            reader_.children(simple, [&](const EbmlElement& child) {
                name = fieldOf(child) == Field::TagName ? reader_.text(child, kMaxWords) : name;
                text = fieldOf(child) == Field::TagText ? reader_.text(child, kMaxWords) : text;
            });
            bound(tags_.size(), kMaxTags, "tags");
            tags_.emplace(name, text);
        });
    });
}

void MatroskaHeader::readAttachments(const EbmlElement& attachments) {
    reader_.children(attachments, [&](const EbmlElement& file) {
        if (fieldOf(file) != Field::AttachedFile) {
            return;
        }
        std::string name;
        std::vector<uint8_t> data;
        reader_.children(file, [&](const EbmlElement& child) {
            name = fieldOf(child) == Field::FileName ? reader_.text(child, kMaxWords) : name;
            if (fieldOf(child) == Field::FileData && child.size() <= kMaxAttached) {
                data = reader_.bytes(child, kMaxAttached);
            }
        });
        if (name.ends_with(".json")) { // others are not used
            bound(attachments_.size(), kMaxFiles, "attached files");
            attachments_.emplace(name, std::move(data));
        }
    });
}

std::string MatroskaHeader::tag(const std::string& name) const {
    const auto found = tags_.find(name);
    return found == tags_.end() ? "" : found->second;
}

int64_t MatroskaHeader::numberTag(const std::string& name) const {
    const std::string text = tag(name);
    int64_t value = 0;
    if (!text.empty() && !parseWhole(text, value)) {
        throw Error("tag " + name + ": '" + text + "' (allowed: a whole number)");
    }
    return value;
}

std::vector<uint8_t> MatroskaHeader::attachment(const std::string& name) const {
    const auto found = attachments_.find(name);
    return found == attachments_.end() ? std::vector<uint8_t>{} : found->second;
}

} // namespace fathom
