// SPDX-License-Identifier: Apache-2.0
// Child processes inherit the given files and no others.
#include "apps/binding/own_process.h"

#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <doctest/doctest.h>
#include <fcntl.h>
#include <filesystem>
#include <string>
#include <sys/wait.h>
#include <unistd.h>
#include <vector>

using namespace fathom;

namespace {

constexpr const char* kChild = "-tc=In a child: its descriptors";

// Output of the child: one line per descriptor that is open in it.
std::string childSays(std::array<int, 5> files) {
    int ends[2] = {-1, -1};
    REQUIRE(::pipe2(ends, O_CLOEXEC) == 0);
    files[1] = ends[1];
    const char* words[] = {"tests", kChild, "-ns", "-m", nullptr};
    pid_t process = -1;
    REQUIRE(startOwnProcess(process, files, words) == 0);
    ::close(ends[1]);
    std::string said;
    char text[4096];
    for (ssize_t got = 0; (got = ::read(ends[0], text, sizeof text)) > 0;) {
        said.append(text, static_cast<size_t>(got));
    }
    ::close(ends[0]);
    int status = -1;
    CHECK(::waitpid(process, &status, 0) == process);
    CHECK(status == 0);
    return said;
}

bool has(const std::string& said, const std::string& line) {
    return said.find(line + "\n") != std::string::npos;
}

} // namespace

TEST_CASE("In a child: its descriptors" * doctest::skip()) {
    for (int file = 0; file < 64; ++file) {
        std::error_code none;
        const auto to = std::filesystem::read_symlink("/proc/self/fd/" + std::to_string(file), none);
        if (!none) {
            std::printf("fd %d: %s\n", file, to.c_str());
        }
    }
    std::printf("session %d\n", ::getsid(0) == ::getpid());
    std::fflush(stdout);
}

TEST_CASE("A child process has the given files at the given descriptors and no others") {
    const int zero = ::open("/dev/zero", O_RDONLY);
    const int kept = ::fcntl(zero, F_DUPFD, 20); // no FD_CLOEXEC, so the child must close it
    ::close(zero);
    const int given = ::open("/dev/full", O_RDONLY | O_CLOEXEC);
    const std::string said = childSays({kNullDevice, -1, STDERR_FILENO, given, kNullDevice});
    ::close(kept);
    ::close(given);
    CAPTURE(said);
    CHECK(has(said, "fd 0: /dev/null"));
    CHECK(has(said, "fd 3: /dev/full"));
    CHECK(has(said, "fd 4: /dev/null"));
    CHECK(said.find("fd 1: pipe:") != std::string::npos);
    CHECK(said.find("fd 2: ") != std::string::npos);
    CHECK(said.find("/dev/zero") == std::string::npos);
    CHECK(has(said, "session 1"));
}

TEST_CASE("With standard error closed, the file that reuses its number does not reach the child") {
    const int saved = ::fcntl(STDERR_FILENO, F_DUPFD_CLOEXEC, 10);
    REQUIRE(saved >= 0);
    ::close(STDERR_FILENO);
    const std::string without = childSays({kNullDevice, -1, STDERR_FILENO, kNullDevice, kNullDevice});
    const int taken = ::open("/dev/full", O_RDONLY | O_CLOEXEC); // reuses the number
    const std::string with = childSays({kNullDevice, -1, STDERR_FILENO, kNullDevice, kNullDevice});
    ::dup2(saved, STDERR_FILENO);
    ::close(saved);
    CHECK(taken == STDERR_FILENO);
    for (const std::string& said : {without, with}) {
        CAPTURE(said);
        CHECK(has(said, "fd 2: /dev/null"));
        CHECK(said.find("/dev/full") == std::string::npos);
    }
}

TEST_CASE("Waiting for a child ends when it ends, or after the timeout when it still runs") {
    const pid_t process = ::fork();
    REQUIRE(process >= 0);
    if (process == 0) {
        ::pause();
        ::_exit(0);
    }
    CHECK_FALSE(waitForEnd(process, std::chrono::milliseconds(20)));
    ::kill(process, SIGKILL);
    CHECK(waitForEnd(process, std::chrono::seconds(60)));
    CHECK(::waitpid(process, nullptr, WNOHANG) == -1); // reaped
}

TEST_CASE("A closed file, or too many files, start no process") {
    pid_t process = -1;
    const char* words[] = {"tests", kChild, nullptr};
    const std::vector<int> many(9, kNullDevice);
    CHECK(startOwnProcess(process, many, words) == EINVAL);
    const std::array<int, 1> closed{-1};
    CHECK(startOwnProcess(process, closed, words) == EBADF);
    CHECK(process == -1);
}
