// SPDX-License-Identifier: Apache-2.0
// An MCAP file, with or without chunks. Source: mcap.dev/spec.
#pragma once

#include "devices/bag/file_bytes.h"
#include "devices/bag/message_file.h"
#include "devices/bag/unpacked_chunks.h"

#include <map>

namespace fathom {

// Chunks are uncompressed, LZ4 frames or zstd; messages may be zstd frames, too. Opening reads the summary
// and the indexes behind chunks; a file without a summary that agrees with them is read record by record, to
// its last whole record where it was not finished, with a warning. Chunks are read when their messages are.
class McapFile final : public MessageFile {
public:
    // Throws BadInput that names the file.
    explicit McapFile(const std::filesystem::path& file);
    MessageBytes bytes(const MessageEntry& entry) override;
    uint64_t bytesRead() const { return in_.bytesRead(); } // of the file, so far

private:
    struct Chunk {
        uint64_t at = 0; // offset of its content in the file
        uint64_t size = 0;
        bool indexed = false;
    };
    bool useSummary();
    void readIndexes(uint64_t at, uint64_t size);
    void scan();
    bool record(uint8_t kind, uint64_t at, uint64_t size);
    std::vector<uint8_t> content(uint64_t at, uint64_t size);
    void readSchema(std::span<const uint8_t> content);
    void readChannel(std::span<const uint8_t> content);
    void readIndex(std::span<const uint8_t> content);
    void add(uint16_t channel, const MessageEntry& entry);
    void readUnindexed();
    void scanChunk(const Chunk& chunk, bool messages);
    void resolve();
    UnpackedChunk unpack(uint64_t chunkAt);

    FileBytes in_;
    uint64_t messages_ = 0;
    std::map<uint16_t, std::string> schemas_;
    std::map<uint16_t, size_t> channels_; // topics
    std::map<uint16_t, std::vector<MessageEntry>> found_;
    std::vector<Chunk> chunks_;
    UnpackedChunks unpacked_;
};

} // namespace fathom
