// SPDX-License-Identifier: Apache-2.0
// A file that is written completely or not at all: writes go to a temporary file in the same folder, which
// commit() renames.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace fathom {

// Whether the name, links not followed, is still that of the open file.
bool isOpenAs(int descriptor, const std::filesystem::path& name) noexcept;

// Buffers at most one megabyte. One thread. Follows no link. Every failure (missing folder, no permission,
// disk full, `path` is a folder, device or pipe, an input of this process, or written by another program)
// throws Error that names the file. Without commit(), the destructor leaves an older file at `path`
// unchanged.
class OutputFile {
public:
    // Input: `path` may be an input of this process, for a program that edits a file.
    enum class Replaces { NoInput, Input };
    explicit OutputFile(std::filesystem::path path, Replaces replaces = Replaces::NoInput);
    OutputFile(OutputFile&& other) noexcept;
    OutputFile& operator=(OutputFile&&) = delete;
    ~OutputFile();

    void write(const void* bytes, size_t count);
    void write(std::string_view text) { write(text.data(), text.size()); }
    // Flushes, closes and renames over `path`. No writes after this.
    void commit();
    // What can fail of commit() before the rename, such as a full disk. No writes after this.
    void complete();

    const std::filesystem::path& path() const { return path_; }

private:
    void refuseReplacing() const; // throws BadInput when `path` is an input and must not be
    void flush();
    void writeAll(const char* bytes, size_t count);
    [[noreturn]] void fail(const char* what) const;

    std::filesystem::path path_, temporary_;
    Replaces replaces_;
    int descriptor_ = -1;
    std::vector<char> buffer_;
};

// Commits files that belong together: all are complete before the first one gets its name. The last file
// marks a complete set: its older version is removed before, then `outdated`: files of an older set without
// a successor. If that fails, no file is replaced.
void commitTogether(std::span<OutputFile* const> files, std::span<const std::filesystem::path> outdated = {});

} // namespace fathom
