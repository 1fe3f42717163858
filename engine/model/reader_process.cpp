// SPDX-License-Identifier: Apache-2.0
#include "engine/model/reader_process.h"

#include "engine/types/error.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <fstream>
#include <stdexcept>
#include <type_traits>

#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#ifdef FATHOM_SANITIZED
#include <sanitizer/common_interface_defs.h>
#endif

namespace fathom {

namespace {

constexpr rlim_t kMostSeconds = 60;     // of CPU time
constexpr unsigned kMostPatience = 300; // [s] wall time, for a reader that blocks
constexpr uint64_t kMostText = 4096;

constexpr int kReported = 86; // exit code of a child that a sanitizer stopped outside the library

bool libraryAtWork = false; // in the child, which has one thread

template <class Byte>
bool moveAll(ssize_t (*move)(int, Byte*, size_t), int pipe, Byte* data, size_t size) {
    auto* at = static_cast<std::conditional_t<std::is_const_v<Byte>, const char, char>*>(data);
    while (size > 0) {
        const ssize_t done = move(pipe, at, size);
        if (done < 0 && errno == EINTR) {
            continue;
        }
        if (done <= 0) {
            return false;
        }
        at += done;
        size -= static_cast<size_t>(done);
    }
    return true;
}

// Limit for this process, the parent's address space included [bytes]; 0 when it is unknown, or under a
// sanitizer, which maps terabytes.
rlim_t mappedNow() {
#ifdef FATHOM_SANITIZED
    return 0;
#endif
    rlim_t pages = 0;
    std::ifstream("/proc/self/statm") >> pages;
    return pages * static_cast<rlim_t>(::sysconf(_SC_PAGESIZE));
}

[[noreturn]] void child(const ReaderProcess& reader, int pipe) {
    for (const int fault : {SIGSEGV, SIGBUS, SIGILL, SIGFPE, SIGABRT, SIGINT, SIGTERM, SIGALRM}) {
        std::signal(fault, SIG_DFL); // default action: the child ends without a message
    }
#ifdef FATHOM_SANITIZED
    __sanitizer_set_death_callback([] {
        if (!libraryAtWork) {
            ::_exit(kReported);
        }
    });
#endif
    ::alarm(kMostPatience);
    const rlimit none{0, 0}, time{kMostSeconds, kMostSeconds};
    ::setrlimit(RLIMIT_CORE, &none);
    ::setrlimit(RLIMIT_CPU, &time);
    if (const rlim_t mapped = mappedNow(); mapped > 0) {
        const rlimit memory{mapped + reader.mostMemory, mapped + reader.mostMemory};
        ::setrlimit(RLIMIT_AS, &memory);
    }
    ::_exit(reader.read(pipe) ? 0 : 1);
}

} // namespace

LibraryAtWork::LibraryAtWork() noexcept {
    libraryAtWork = true;
}

LibraryAtWork::~LibraryAtWork() {
    libraryAtWork = false;
}

bool writeAll(int pipe, const void* data, size_t size) {
    return moveAll<const void>(::write, pipe, data, size);
}

bool readAll(int pipe, void* data, size_t size) {
    return moveAll<void>(::read, pipe, data, size);
}

bool writeText(int pipe, const std::string& text) {
    const uint64_t size = std::min<uint64_t>(text.size(), kMostText);
    return writeAll(pipe, &size, sizeof size) && writeAll(pipe, text.data(), size);
}

bool readText(int pipe, std::string& text) {
    uint64_t size = 0;
    if (!readAll(pipe, &size, sizeof size) || size > kMostText) {
        return false;
    }
    text.resize(size);
    return readAll(pipe, text.data(), size);
}

ReaderEnd runReader(const std::filesystem::path& file, const ReaderProcess& reader) {
    std::array<int, 2> pipe{};
    if (::pipe(pipe.data()) != 0) {
        throw Error(file.string() + ": no pipe: " + std::strerror(errno));
    }
    const pid_t process = ::fork();
    if (process == 0) {
        ::close(pipe[0]);
        child(reader, pipe[1]);
    }
    ::close(pipe[1]);
    ReaderEnd end;
    end.whole = process > 0 && reader.take(pipe[0]);
    ::close(pipe[0]);
    int status = 0;
    while (process > 0 && ::waitpid(process, &status, 0) < 0 && errno == EINTR) {
    }
    if (process < 0) {
        throw Error(file.string() + ": cannot start a reader process");
    }
    if (WIFEXITED(status) && WEXITSTATUS(status) == kReported) {
        throw std::logic_error(file.string() + ": a sanitizer ended its reader in Fathom's own code");
    }
    end.signal = WIFSIGNALED(status) ? WTERMSIG(status) : 0;
    return end;
}

std::string broken(const std::string& reader, const ReaderEnd& end) {
    return "breaks the " + reader +
           (end.signal != 0 ? " (signal " + std::to_string(end.signal) + ")" : std::string());
}

} // namespace fathom
