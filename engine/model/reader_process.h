// SPDX-License-Identifier: Apache-2.0
// A process of its own for what a library reads of strangers: large parsers can be crashed by broken files,
// and a crash there must be a refusal here.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>

namespace fathom {

// All of it through a pipe, in as many calls as that takes; false when the other side is gone.
bool writeAll(int pipe, const void* data, size_t size);
bool readAll(int pipe, void* data, size_t size);
// A text with its length before it, 4 KiB at most.
bool writeText(int pipe, const std::string& text);
bool readText(int pipe, std::string& text);

struct ReaderProcess {
    // In the child: reads, writes to the pipe, says whether all is said. std::bad_alloc there is for it to
    // tell of.
    std::function<bool(int pipe)> read;
    // Here: takes what comes; false when that is not whole.
    std::function<bool(int pipe)> take;
    uint64_t mostMemory = uint64_t{4} << 30; // [bytes] of address space beyond what this process has
};

// While one lives, the library is at work in the child: what a sanitizer says is then its own fault, and a
// refusal as a crash is.
class LibraryAtWork {
public:
    LibraryAtWork() noexcept;
    ~LibraryAtWork();
    LibraryAtWork(const LibraryAtWork&) = delete;
    LibraryAtWork& operator=(const LibraryAtWork&) = delete;
};

// A child is forked, so that no thread is needed. It takes memory and uses a library, and a lock that another
// thread of this process holds at that moment stays held in it: call this while no other thread works. It has
// at most a minute of CPU time and five minutes in all, and so much memory (no bound under a sanitizer, whose
// own memory is none). Returns the signal that ended it (0: none), and whether take() was served. Throws
// Error, naming the file, when no child can be made; std::logic_error, which is no refusal, when a sanitizer
// ended the child in code of ours.
struct ReaderEnd {
    bool whole = false;
    int signal = 0;
};
ReaderEnd runReader(const std::filesystem::path& file, const ReaderProcess& reader);
// "breaks the <reader>", with the signal.
std::string broken(const std::string& reader, const ReaderEnd& end);

} // namespace fathom
