// SPDX-License-Identifier: Apache-2.0
// Reads a file at any place, and no more of it than is asked for.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

namespace fathom {

// A regular file, open for reading. One thread.
class FileBytes {
public:
    // Not open where the file is missing, unreadable or not a regular file.
    explicit FileBytes(const std::filesystem::path& file);
    FileBytes(const FileBytes&) = delete;
    FileBytes& operator=(const FileBytes&) = delete;
    ~FileBytes();

    bool open() const { return file_ >= 0; }
    uint64_t size() const { return size_; } // [bytes] when it was opened
    // Whether the system may read ahead: not while single records all over the file are looked at.
    void readAhead(bool wanted) const;
    // Throws Error "truncated" when the file ends before.
    void read(uint64_t at, std::span<uint8_t> to);
    // Throws Error when there are more than `most`, before it takes memory.
    std::vector<uint8_t> read(uint64_t at, uint64_t count, uint64_t most);
    uint64_t bytesRead() const { return read_; } // in all

private:
    int file_ = -1;
    uint64_t size_ = 0, read_ = 0;
};

} // namespace fathom
