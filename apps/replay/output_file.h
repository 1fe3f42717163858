// SPDX-License-Identifier: Apache-2.0
// A file that appears whole or not at all: buffered writes to a temporary name beside it, renamed by
// commit().
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace fathom {

// Holds one megabyte at most, whatever is written. One thread. Every failure (no such folder, not writable,
// disk full, a folder, device or pipe at `path`) throws Error that names the file. Destroyed without
// commit(), it leaves what stood at `path` before untouched.
class OutputFile {
public:
    explicit OutputFile(std::filesystem::path path);
    OutputFile(OutputFile&& other) noexcept;
    OutputFile& operator=(OutputFile&&) = delete;
    ~OutputFile();

    void write(const void* bytes, size_t count);
    void write(std::string_view text) { write(text.data(), text.size()); }
    // Flushes, closes and renames over `path`. Nothing may be written after.
    void commit();

    const std::filesystem::path& path() const { return path_; }

private:
    void flush();
    void writeAll(const char* bytes, size_t count);
    [[noreturn]] void fail(const char* what) const;

    std::filesystem::path path_, temporary_;
    int descriptor_ = -1;
    std::vector<char> buffer_;
};

// Makes `folder` (and fixtures/ in it when asked for) and takes away the frame and fault files of an earlier
// run, so that no set of another run stands beside this one's. Throws Error that names the folder.
void prepareOutputFolder(const std::filesystem::path& folder, bool withFixtures);

} // namespace fathom
