// SPDX-License-Identifier: Apache-2.0
// A ROS 1 bag, format 2.0: its topics and, through its index, any message. Source:
// wiki.ros.org/Bags/Format/2.0.
#pragma once

#include "devices/bag/message_file.h"
#include "devices/bag/unpacked_chunks.h"

#include <fstream>
#include <map>
#include <optional>

namespace fathom {

// One thread. Chunks are uncompressed, bz2 or LZ4 frames; the four most recent ones stay unpacked in memory.
class BagFile final : public MessageFile {
public:
    // Throws BadInput that names the file: not a bag of version 2.0, not indexed (not closed), or damaged.
    explicit BagFile(const std::filesystem::path& file);
    MessageBytes bytes(const MessageEntry& entry) override;

private:
    using Fields = std::map<std::string, std::string>;
    struct Record {
        Fields fields;
        std::vector<uint8_t> data;
    };

    Record readRecord();
    std::vector<uint8_t> readBlock();
    std::optional<Record> nextOfIndex(bool complete);
    // connections, chunkInfos: records of the index by the bag's head.
    void readIndex(uint64_t indexAt, uint64_t connections, uint64_t chunkInfos);
    void readChunkIndex(uint64_t chunkAt, std::map<uint32_t, size_t>& topicOf);
    UnpackedChunk unpack(uint64_t chunkAt);

    std::ifstream in_;
    uint64_t size_ = 0;
    UnpackedChunks unpacked_;
};

} // namespace fathom
