// SPDX-License-Identifier: Apache-2.0
#include "devices/bag/bag_file.h"

#include "devices/bag/bag_records.h"
#include "devices/bag/byte_cursor.h"
#include "devices/bag/unpack_chunk.h"
#include "engine/types/printable.h"
#include "engine/types/read_file.h"

#include <algorithm>
#include <string_view>

namespace fathom {

namespace {

constexpr char kBagMagic[] = "#ROSBAG V2.0\n";
} // namespace

bag::Fields bag::parseFields(std::span<const uint8_t> bytes) {
    Fields fields;
    for (ByteCursor cursor(bytes); !cursor.empty();) {
        const std::string field = cursor.text();
        const size_t equals = field.find('=');
        if (equals == std::string::npos) {
            throw Error("a header field without '='");
        }
        fields[field.substr(0, equals)] = field.substr(equals + 1);
    }
    return fields;
}

std::string bag::word(const Fields& fields, const char* name) {
    const auto it = fields.find(name);
    return it == fields.end() ? "" : printable(it->second);
}

BagFile::BagFile(const std::filesystem::path& file)
    : MessageFile(file)
    , in_(isRegularFile(file) ? std::ifstream(file, std::ios::binary) : std::ifstream()) {
    std::error_code failed;
    size_ = std::filesystem::file_size(file, failed);
    if (const std::string fault = failed || !in_.is_open() ? whyUnreadable(file) : magicFault();
        !fault.empty()) {
        throw BadInput(file.string(), "format", fault, "a ROS 1 bag of version 2.0");
    }
    uint64_t chunksAt = 0, indexAt = 0;
    std::string lost = "no index";
    try {
        const Record header = readRecord();
        if (bag::number<uint8_t>(header.fields, "op") != bag::kBagHeader) {
            throw Error("no bag header");
        }
        chunksAt = static_cast<uint64_t>(in_.tellg());
        indexAt = bag::number<uint64_t>(header.fields, "index_pos");
        const auto count = [&](const char* name) { // unknown: the index is complete at the end of the file
            return header.fields.contains(name) ? bag::number<uint32_t>(header.fields, name) : UINT64_MAX;
        };
        if (indexAt != 0 && indexAt < size_) {
            lost = readIndex(indexAt, count("conn_count"), count("chunk_count"));
        }
    } catch (const Error& e) {
        throw BadInput(file.string(), "content", e.what(), "a ROS 1 bag of version 2.0");
    }
    if (!lost.empty()) {
        scan(chunksAt, indexAt < size_ ? indexAt : 0, lost);
    }
}

// Reads the first line; why the file is no bag that is read, empty = it is one.
std::string BagFile::magicFault() {
    constexpr std::string_view kAnyVersion = "#ROSBAG V", kMagic = kBagMagic;
    std::string magic(kMagic.size(), ' ');
    in_.read(magic.data(), static_cast<std::streamsize>(magic.size()));
    if (size_ == 0) {
        return "empty";
    }
    if (in_ && magic == kMagic) {
        return "";
    }
    if (!magic.starts_with(kAnyVersion)) {
        return "no bag";
    }
    std::string version = magic.substr(kAnyVersion.size());
    version.erase(std::min(version.find_first_of("\r\n "), version.size()));
    return "a bag of version " + printable(version) + ", which rosbag fix of ROS 1 converts";
}

std::vector<uint8_t> BagFile::readBlock() {
    uint32_t count = 0;
    in_.read(reinterpret_cast<char*>(&count), sizeof count);
    if (!in_ || count > bag::kMaxBytes || count > size_) {
        throw Error("truncated");
    }
    std::vector<uint8_t> bytes(count);
    in_.read(reinterpret_cast<char*>(bytes.data()), count);
    if (!in_) {
        throw Error("truncated");
    }
    return bytes;
}

BagFile::Record BagFile::readRecord() {
    Record record;
    record.fields = bag::parseFields(readBlock());
    record.data = readBlock();
    return record;
}

// The next record of the index. Empty at the end of the file, and at bytes that are no record where the index
// is complete: file systems and archives leave zeros there.
std::optional<BagFile::Record> BagFile::nextOfIndex(bool complete) {
    if (static_cast<uint64_t>(in_.tellg()) >= size_) {
        return std::nullopt;
    }
    try {
        Record record = readRecord();
        bag::number<uint8_t>(record.fields, "op");
        return record;
    } catch (const Error&) {
        if (!complete) {
            throw;
        }
        in_.clear();
        return std::nullopt;
    }
}

// Returns why it cannot be used; empty = it can.
std::string BagFile::readIndex(uint64_t indexAt, uint64_t connections, uint64_t chunkInfos) {
    try {
        useIndex(indexAt, connections, chunkInfos);
        return "";
    } catch (const Error& e) {
        return "damaged index (" + std::string(e.what()) + ")";
    }
}

void BagFile::useIndex(uint64_t indexAt, uint64_t connections, uint64_t chunkInfos) {
    std::map<uint32_t, size_t> topicOf; // of a connection
    std::vector<uint64_t> chunks;
    in_.seekg(static_cast<std::streamoff>(indexAt));
    while (const auto next = nextOfIndex(topicOf.size() >= connections && chunks.size() >= chunkInfos)) {
        const Record& record = *next;
        const auto op = bag::number<uint8_t>(record.fields, "op");
        if (op == bag::kConnection) {
            const std::string name = bag::word(record.fields, "topic");
            topicOf[bag::number<uint32_t>(record.fields, "conn")] =
                topicAt(name, bag::word(bag::parseFields(record.data), "type"), false);
        } else if (op == bag::kChunkInfo) {
            chunks.push_back(bag::number<uint64_t>(record.fields, "chunk_pos"));
        }
    }
    std::sort(chunks.begin(), chunks.end());
    if (std::adjacent_find(chunks.begin(), chunks.end()) != chunks.end()) {
        throw Error("the index names a chunk twice"); // a repeated chunk would duplicate its messages
    }
    for (const uint64_t chunk : chunks) {
        readChunkIndex(chunk, topicOf);
    }
    sortByTime();
}

// A chunk is followed by its index records, one per connection, with time and offset of each message.
void BagFile::readChunkIndex(uint64_t chunkAt, std::map<uint32_t, size_t>& topicOf) {
    in_.seekg(static_cast<std::streamoff>(chunkAt));
    if (bag::number<uint8_t>(bag::parseFields(readBlock()), "op") != bag::kChunk) {
        throw Error("the index does not point to a chunk");
    }
    uint32_t size = 0; // of the chunk, which is not read
    in_.read(reinterpret_cast<char*>(&size), sizeof size);
    in_.seekg(size, std::ios::cur);
    if (!in_ || static_cast<uint64_t>(in_.tellg()) > size_) {
        throw Error("truncated");
    }
    while (static_cast<uint64_t>(in_.tellg()) < size_) {
        const Fields fields = bag::parseFields(readBlock());
        if (bag::number<uint8_t>(fields, "op") != bag::kIndexData) {
            return; // the next chunk, which is not read either
        }
        const std::vector<uint8_t> index = readBlock();
        const auto topic = topicOf.find(bag::number<uint32_t>(fields, "conn"));
        if (topic == topicOf.end()) {
            throw Error("the index names a missing connection");
        }
        for (ByteCursor cursor(index); !cursor.empty();) {
            const uint32_t seconds = cursor.word(), nanos = cursor.word(), offset = cursor.word();
            topics_[topic->second].messages.push_back({seconds * 1000000000ull + nanos, chunkAt, offset});
        }
    }
}

UnpackedChunk BagFile::unpack(uint64_t chunkAt) {
    return unpacked_.at(chunkAt, [&] {
        in_.clear();
        in_.seekg(static_cast<std::streamoff>(chunkAt));
        if (chunkAt == begun_) {
            return begunChunk();
        }
        const Record record = readRecord();
        const auto size = bag::number<uint32_t>(record.fields, "size");
        if (size > bag::kMaxBytes) {
            throw Error("a chunk of " + std::to_string(size) + " bytes");
        }
        return unpackChunk(bag::word(record.fields, "compression"), record.data, size);
    });
}

MessageBytes BagFile::bytes(const MessageEntry& entry) {
    const UnpackedChunk chunk = unpack(entry.chunk);
    ByteCursor cursor(*chunk);
    cursor.take(entry.offset);
    if (bag::number<uint8_t>(bag::parseFields(cursor.block()), "op") != bag::kMessage) {
        throw Error("the index does not point to a message");
    }
    return {cursor.block(), chunk};
}

} // namespace fathom
