// SPDX-License-Identifier: Apache-2.0
#include "devices/bag/bag_file.h"

#include "devices/bag/byte_cursor.h"
#include "devices/bag/unpack_chunk.h"
#include "engine/types/printable.h"
#include "engine/types/read_file.h"

#include <algorithm>

namespace fathom {

namespace {

constexpr char kBagMagic[] = "#ROSBAG V2.0\n";
constexpr uint8_t kMessage = 2, kBagHeader = 3, kIndexData = 4, kChunk = 5, kChunkInfo = 6, kConnection = 7;
constexpr uint32_t kBagBytes = 1u << 30; // of one record or chunk

std::map<std::string, std::string> parseFields(std::span<const uint8_t> bytes) {
    std::map<std::string, std::string> fields;
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

template <class T>
T number(const std::map<std::string, std::string>& fields, const char* name) {
    const auto it = fields.find(name);
    if (it == fields.end() || it->second.size() != sizeof(T)) {
        throw Error(std::string("a header without '") + name + "'");
    }
    T value;
    std::memcpy(&value, it->second.data(), sizeof(T));
    return value;
}

std::string word(const std::map<std::string, std::string>& fields, const char* name) {
    const auto it = fields.find(name);
    return it == fields.end() ? "" : printable(it->second);
}

} // namespace

BagFile::BagFile(const std::filesystem::path& file)
    : MessageFile(file)
    , in_(isRegularFile(file) ? std::ifstream(file, std::ios::binary) : std::ifstream()) {
    std::error_code failed;
    size_ = std::filesystem::file_size(file, failed);
    std::string magic(sizeof kBagMagic - 1, ' ');
    if (failed || !in_.is_open() || !in_.read(magic.data(), static_cast<std::streamsize>(magic.size())) ||
        magic != kBagMagic) {
        throw BadInput(file.string(), "format", in_.is_open() ? "no bag" : whyUnreadable(file),
                       "a ROS 1 bag of version 2.0");
    }
    try {
        const Record header = readRecord();
        if (number<uint8_t>(header.fields, "op") != kBagHeader) {
            throw Error("no bag header");
        }
        const auto indexAt = number<uint64_t>(header.fields, "index_pos");
        if (indexAt == 0 || indexAt >= size_) {
            throw BadInput(file.string(), "index", "no index: the bag was not closed",
                           "an indexed bag (rosbag reindex)");
        }
        const auto count = [&](const char* name) { // unknown: the index is complete at the end of the file
            return header.fields.contains(name) ? number<uint32_t>(header.fields, name) : UINT64_MAX;
        };
        readIndex(indexAt, count("conn_count"), count("chunk_count"));
    } catch (const BadInput&) {
        throw;
    } catch (const Error& e) {
        throw BadInput(file.string(), "content", e.what(),
                       "a complete ROS 1 bag of version 2.0 (rosbag reindex)");
    }
}

std::vector<uint8_t> BagFile::readBlock() {
    uint32_t count = 0;
    in_.read(reinterpret_cast<char*>(&count), sizeof count);
    if (!in_ || count > kBagBytes || count > size_) {
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
    record.fields = parseFields(readBlock());
    record.data = readBlock();
    return record;
}

// The next record of the index. Empty at the end of the file, and at bytes that are no record where the index is
// complete: file systems and archives leave zeros there.
std::optional<BagFile::Record> BagFile::nextOfIndex(bool complete) {
    if (static_cast<uint64_t>(in_.tellg()) >= size_) {
        return std::nullopt;
    }
    try {
        Record record = readRecord();
        number<uint8_t>(record.fields, "op");
        return record;
    } catch (const Error&) {
        if (!complete) {
            throw;
        }
        in_.clear();
        return std::nullopt;
    }
}

void BagFile::readIndex(uint64_t indexAt, uint64_t connections, uint64_t chunkInfos) {
    std::map<uint32_t, size_t> topicOf; // of a connection
    std::vector<uint64_t> chunks;
    in_.seekg(static_cast<std::streamoff>(indexAt));
    while (const auto next = nextOfIndex(topicOf.size() >= connections && chunks.size() >= chunkInfos)) {
        const Record& record = *next;
        const auto op = number<uint8_t>(record.fields, "op");
        if (op == kConnection) {
            const std::string name = word(record.fields, "topic");
            topicOf[number<uint32_t>(record.fields, "conn")] =
                topicAt(name, word(parseFields(record.data), "type"), false);
        } else if (op == kChunkInfo) {
            chunks.push_back(number<uint64_t>(record.fields, "chunk_pos"));
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
    if (number<uint8_t>(parseFields(readBlock()), "op") != kChunk) {
        throw Error("the index does not point to a chunk");
    }
    uint32_t size = 0; // of the chunk, which is not read
    in_.read(reinterpret_cast<char*>(&size), sizeof size);
    in_.seekg(size, std::ios::cur);
    if (!in_ || static_cast<uint64_t>(in_.tellg()) > size_) {
        throw Error("truncated");
    }
    while (static_cast<uint64_t>(in_.tellg()) < size_) {
        const Fields fields = parseFields(readBlock());
        if (number<uint8_t>(fields, "op") != kIndexData) {
            return; // the next chunk, which is not read either
        }
        const std::vector<uint8_t> index = readBlock();
        const auto topic = topicOf.find(number<uint32_t>(fields, "conn"));
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
        const Record record = readRecord();
        const auto size = number<uint32_t>(record.fields, "size");
        if (size > kBagBytes) {
            throw Error("a chunk of " + std::to_string(size) + " bytes");
        }
        return unpackChunk(word(record.fields, "compression"), record.data, size);
    });
}

MessageBytes BagFile::bytes(const MessageEntry& entry) {
    const UnpackedChunk chunk = unpack(entry.chunk);
    ByteCursor cursor(*chunk);
    cursor.take(entry.offset);
    if (number<uint8_t>(parseFields(cursor.block()), "op") != kMessage) {
        throw Error("the index does not point to a message");
    }
    return {cursor.block(), chunk};
}

} // namespace fathom
