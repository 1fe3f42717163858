// SPDX-License-Identifier: Apache-2.0
// A ROS 1 bag, format 2.0: its topics and, through its index, any message. Source:
// wiki.ros.org/Bags/Format/2.0.
#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <map>
#include <span>
#include <string>
#include <vector>

namespace fathom {

// Location of one message.
struct BagEntry {
    uint64_t time = 0;   // [ns] when it was recorded
    uint64_t chunk = 0;  // offset of the chunk record in the file
    uint32_t offset = 0; // in the chunk, unpacked
};

// One topic of a bag, with all of its messages.
struct BagTopic {
    std::string name, type;
    std::vector<BagEntry> messages; // in order of time
};

// One thread. Chunks are uncompressed, bz2 or LZ4 frames; the two most recent ones stay unpacked in memory.
class BagFile {
public:
    // Throws BadInput that names the file: not a bag of version 2.0, not indexed (not closed), or damaged.
    explicit BagFile(const std::filesystem::path& file);

    const std::vector<BagTopic>& topics() const { return topics_; }
    // Null when there is no such topic.
    const BagTopic* find(const std::string& name) const;
    // The serialised message. Valid until two other chunks have been read. Throws Error.
    std::span<const uint8_t> read(const BagEntry& entry);
    const std::filesystem::path& file() const { return file_; }

private:
    using Fields = std::map<std::string, std::string>;
    struct Record {
        Fields fields;
        std::vector<uint8_t> data;
    };
    struct Unpacked {
        uint64_t chunk = 0;
        std::vector<uint8_t> bytes;
        uint64_t used = 0;
    };

    Record readRecord();
    std::vector<uint8_t> readBlock();
    void readIndex(uint64_t indexAt);
    void readChunkIndex(uint64_t chunkAt, std::map<uint32_t, size_t>& topicOf);
    const Unpacked& unpack(uint64_t chunkAt);

    std::filesystem::path file_;
    std::ifstream in_;
    uint64_t size_ = 0;
    std::vector<BagTopic> topics_;
    std::vector<Unpacked> unpacked_;
    uint64_t clock_ = 0;
};

} // namespace fathom
