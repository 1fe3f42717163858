// SPDX-License-Identifier: Apache-2.0
#include "devices/images/exr_header.h"

#include "devices/bag/byte_cursor.h"
#include "devices/images/exr_channel.h"
#include "devices/recorded/recording_intrinsics.h"
#include "engine/types/number_text.h"

#include <algorithm>
#include <map>

namespace fathom {

namespace {

constexpr size_t kMaxExrChannels = 64, kMaxExrAttributes = 1000, kMaxExrName = 255;
constexpr uint32_t kExrPlain = 2, kExrLongNames = 0x400; // version 2, and a flag that changes nothing here

struct ExrBox {
    int32_t left = 0, top = 0, right = 0, bottom = 0; // all inside
    bool operator==(const ExrBox&) const = default;
};

std::string exrName(ByteCursor& cursor) {
    std::string name;
    for (char c = static_cast<char>(cursor.value<uint8_t>()); c != '\0';
         c = static_cast<char>(cursor.value<uint8_t>())) {
        name += c;
        if (name.size() > kMaxExrName) {
            throw Error("EXR: a name of over 255 bytes");
        }
    }
    return name;
}

std::vector<ExrChannel> exrChannels(ByteCursor cursor) {
    std::vector<ExrChannel> channels;
    for (std::string name = exrName(cursor); !name.empty(); name = exrName(cursor)) {
        channels.push_back({name, cursor.word()});
        cursor.word(); // a hint on brightness
        const uint32_t across = cursor.word(), down = cursor.word();
        if (channels.size() > kMaxExrChannels || channels.back().kind > 2 || across != 1 || down != 1) {
            throw Error("EXR: channels (allowed: at most 64, without subsampling)");
        }
    }
    return channels;
}

std::map<std::string, ImageBytes> exrAttributes(ByteCursor& cursor) {
    std::map<std::string, ImageBytes> attributes;
    for (std::string name = exrName(cursor); !name.empty(); name = exrName(cursor)) {
        exrName(cursor); // its type follows from its name
        attributes[name] = cursor.block();
        if (attributes.size() > kMaxExrAttributes) {
            throw Error("EXR: more than 1000 attributes");
        }
    }
    return attributes;
}

ImageBytes exrAttribute(const std::map<std::string, ImageBytes>& all, const char* name) {
    const auto found = all.find(name);
    if (found == all.end()) {
        throw Error(std::string("EXR: no attribute ") + name);
    }
    return found->second;
}

void chooseChannel(const std::vector<ExrChannel>& channels, ExrHeader& head) {
    const ExrDepth chosen = chooseExrDepth(channels);
    const uint32_t kind = channels[chosen.depth].kind;
    head.half = kind == 1;
    for (size_t i = 0; i < channels.size(); ++i) {
        if (i == chosen.depth) {
            head.channelAt = head.rowBytes;
        } else if (std::ranges::count(chosen.equal, i) != 0) {
            if (channels[i].kind != kind) {
                throw Error("EXR: channels: R, G and B of different types (allowed: depth)");
            }
            head.equalAt.push_back(head.rowBytes);
        }
        head.rowBytes += head.width * channels[i].bytes();
    }
}

void takeWindow(const std::map<std::string, ImageBytes>& all, ExrHeader& head) {
    const auto data = ByteCursor(exrAttribute(all, "dataWindow")).value<ExrBox>();
    if (data != ByteCursor(exrAttribute(all, "displayWindow")).value<ExrBox>()) {
        throw Error("EXR: dataWindow (allowed: equal to displayWindow)");
    }
    const int64_t width = int64_t{data.right} - data.left + 1, height = int64_t{data.bottom} - data.top + 1;
    if (width < 1 || height < 1 || width > kMaxImageWidth || height > kMaxImageHeight) {
        throw Error("EXR: " + sizeText(width, height) + " pixels (allowed: at most 3840x2160)");
    }
    head.width = static_cast<uint32_t>(width);
    head.height = static_cast<uint32_t>(height);
    head.firstRow = data.top;
}

void takeCompression(const std::map<std::string, ImageBytes>& all, ExrHeader& head) {
    const auto kind = ByteCursor(exrAttribute(all, "compression")).value<uint8_t>();
    if (kind != 0 && kind != 2 && kind != 3) {
        constexpr const char* kNames[] = {"", "RLE", "", "", "PIZ", "PXR24", "B44", "B44A", "DWAA", "DWAB"};
        throw Error(std::string("EXR: compression: ") +
                    (kind < std::size(kNames) ? kNames[kind] : "unknown") + " (allowed: none, ZIPS, ZIP)");
    }
    head.packed = kind != 0;
    head.rowsPerChunk = kind == 3 ? 16 : 1;
}

void readExrHeader(ImageBytes bytes, ExrHeader& head) {
    ByteCursor cursor(bytes);
    cursor.word(); // magic
    if (const uint32_t version = cursor.word(); (version & ~kExrLongNames) != kExrPlain) {
        throw Error("EXR: tiles, deep data or several parts (allowed: one part of scan lines)");
    }
    const auto attributes = exrAttributes(cursor);
    takeWindow(attributes, head);
    takeCompression(attributes, head);
    chooseChannel(exrChannels(ByteCursor(exrAttribute(attributes, "channels"))), head);
    for (uint32_t row = 0; row < head.height; row += head.rowsPerChunk) {
        head.chunks.push_back(cursor.value<uint64_t>());
    }
}

} // namespace

ExrHeader parseExrHeader(ImageBytes bytes) {
    ExrHeader head;
    try {
        readExrHeader(bytes, head);
    } catch (const Error& e) {
        head.fault = e.what() == std::string_view("truncated") ? "EXR: truncated" : e.what();
    }
    return head;
}

} // namespace fathom
