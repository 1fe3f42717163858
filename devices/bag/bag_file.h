// SPDX-License-Identifier: Apache-2.0
// A ROS 1 bag, format 2.0: its topics and any message. Source: wiki.ros.org/Bags/Format/2.0.
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
    // Without an index, as after a crash, or with a damaged one, all chunks are unpacked once to find the
    // messages, also those behind damaged places, and one line says so. Throws BadInput that names the file:
    // not a bag of version 2.0, or without a whole message.
    explicit BagFile(const std::filesystem::path& file);
    MessageBytes bytes(const MessageEntry& entry) override;

private:
    using Fields = std::map<std::string, std::string>;
    struct Record {
        Fields fields;
        std::vector<uint8_t> data;
    };
    struct Header {
        Fields fields;
        uint8_t op = 0;
        uint64_t end = 0;                // of the record [bytes of the file]
        bool empty = false, cut = false; // by the file's end
    };

    std::string magicFault();
    Record readRecord();
    std::vector<uint8_t> readBlock();
    std::optional<Record> nextOfIndex(bool complete);
    // connections, chunkInfos: records of the index by the bag's header.
    std::string readIndex(uint64_t indexAt, uint64_t connections, uint64_t chunkInfos);
    void useIndex(uint64_t indexAt, uint64_t connections, uint64_t chunkInfos);
    void readChunkIndex(uint64_t chunkAt, std::map<uint32_t, size_t>& topicOf);
    // lost: why there is no index. indexAt: 0 = none.
    void scan(uint64_t chunksAt, uint64_t indexAt, const std::string& lost);
    std::map<uint32_t, size_t> connectionsAt(uint64_t indexAt);
    std::optional<Header> headerAt(uint64_t at);
    std::optional<uint64_t> nextChunk(uint64_t from);
    uint64_t scanChunk(uint64_t chunkAt, std::map<uint32_t, size_t>& topicOf);
    std::vector<uint8_t> begunChunk();
    UnpackedChunk unpack(uint64_t chunkAt);

    std::ifstream in_;
    uint64_t size_ = 0;
    std::optional<uint64_t> begun_; // chunk whose size the recorder did not state yet, or that is cut
    UnpackedChunks unpacked_;
};

} // namespace fathom
