// SPDX-License-Identifier: Apache-2.0
// Runs third-party parsers of untrusted files in a child process, so that a crash of the parser becomes a
// rejected file.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>

namespace fathom {

// Writes everything to a pipe, in as many calls as needed; false when the other end is closed.
bool writeAll(int pipe, const void* data, size_t size);
bool readAll(int pipe, void* data, size_t size);
// A length-prefixed text of at most 4 KiB.
bool writeText(int pipe, const std::string& text);
bool readText(int pipe, std::string& text);

struct ReaderProcess {
    // Child: reads the file, writes the result to the pipe, and returns whether all was written. It reports
    // std::bad_alloc itself.
    std::function<bool(int pipe)> read;
    // Parent: reads the result; false when it is incomplete.
    std::function<bool(int pipe)> take;
    uint64_t mostMemory = uint64_t{4} << 30; // [bytes] address space beyond that of this process
};

// While one exists, the library runs in the child: a sanitizer report is then the library's fault and rejects
// the file, as a crash does.
class LibraryAtWork {
public:
    LibraryAtWork() noexcept;
    ~LibraryAtWork();
    LibraryAtWork(const LibraryAtWork&) = delete;
    LibraryAtWork& operator=(const LibraryAtWork&) = delete;
};

// Forks a child. Call it while no other thread runs: a lock that another thread holds at the fork stays held
// in the child, which allocates and calls a library. The child gets at most one minute of CPU time, five
// minutes in total, and `mostMemory` (unlimited under a sanitizer, which maps terabytes). Returns the signal
// that ended it (0 = none) and whether take() got everything. Throws Error that names the file when no child
// can be made, and std::logic_error when a sanitizer stopped the child in Fathom's own code.
struct ReaderEnd {
    bool whole = false;
    int signal = 0;
};
ReaderEnd runReader(const std::filesystem::path& file, const ReaderProcess& reader);
// "breaks the <reader>", with the signal.
std::string broken(const std::string& reader, const ReaderEnd& end);

} // namespace fathom
