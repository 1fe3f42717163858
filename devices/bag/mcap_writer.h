// SPDX-License-Identifier: Apache-2.0
// Writes an MCAP file of ROS 2 messages: chunks packed by zstd, with indexes and a summary. Source: the MCAP
// specification, version 0.
#pragma once

#include "devices/bag/byte_writer.h"
#include "engine/types/output_file.h"

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace fathom {

// Holds one chunk (4 MiB, or one message), and 30 bytes per message. Every call throws Error that names the
// file when it cannot be written. Without finish(), there is no file. One thread.
class McapWriter {
public:
    // chunkBytes: of messages that fill a chunk.
    explicit McapWriter(const std::filesystem::path& file, size_t chunkBytes = size_t{4} << 20);

    // type: "sensor_msgs/msg/Image"; definition: its text with those of the types that it uses.
    uint16_t addChannel(const std::string& topic, const std::string& type, const std::string& definition);
    // message: CDR. time [ns], also of messages that are added out of order.
    void add(uint16_t channel, uint64_t time, std::span<const uint8_t> message);
    void finish();

private:
    struct Span {
        uint64_t first = UINT64_MAX, last = 0; // [ns]
        void add(uint64_t time);
    };
    using Index = std::map<uint16_t, std::vector<std::pair<uint64_t, uint64_t>>>; // time, place in the chunk
    void write(const ByteWriter& bytes);
    void endChunk();
    void writeIndexes(uint64_t chunkAt, uint64_t chunkSize, uint64_t packedSize);
    void statistics(ByteWriter& summary) const;

    OutputFile file_;
    size_t chunkBytes_;
    uint64_t at_ = 0; // [bytes] written
    ByteWriter chunk_, schemas_, channels_, chunkIndexes_;
    Index index_;
    Span chunkSpan_, span_;
    std::map<std::string, uint16_t> schemaOf_; // by type
    std::map<uint16_t, uint64_t> countOf_;     // messages by channel
    uint64_t messages_ = 0;
    uint32_t chunks_ = 0;
};

} // namespace fathom
