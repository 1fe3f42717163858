// SPDX-License-Identifier: Apache-2.0
// Threads and memory of a live run where the kernel permits real-time priority and locked memory.
#include "tests/rig/stage.h"
#include "tests/support/locked_memory.h"
#include "tests/support/sanitized.h"

#include <algorithm>
#include <doctest/doctest.h>
#include <fstream>
#include <iterator>
#include <pthread.h>
#include <sstream>
#include <sys/mman.h>
#include <sys/wait.h>
#include <thread>

using namespace fathom;

namespace {

// True when a thread of this process gets real-time priority and the process may lock its memory.
bool permitted() {
    int fault = 0;
    std::thread([&] {
        const sched_param lowest{1};
        fault = ::pthread_setschedparam(::pthread_self(), SCHED_FIFO, &lowest);
    }).join();
    const bool locks = ::mlockall(MCL_CURRENT | MCL_ONFAULT) == 0;
    ::munlockall();
    return fault == 0 && locks;
}

// Scheduling of one thread: fields 40 and 41 of its stat file (proc(5)), counted after the closing bracket of
// its name.
struct Scheduling {
    int priority = 0, policy = 0;
};

Scheduling schedulingOf(const std::filesystem::path& task) {
    std::ifstream file(task / "stat");
    std::string text{std::istreambuf_iterator<char>(file), {}};
    std::istringstream fields(text.substr(std::min(text.size(), text.rfind(')') + 1)));
    const std::vector<std::string> words{std::istream_iterator<std::string>(fields), {}};
    return words.size() > 38 ? Scheduling{std::stoi(words[37]), std::stoi(words[38])} : Scheduling{};
}

// Priorities of the process's SCHED_FIFO threads. Threads may start and end meanwhile.
std::vector<int> realTimePriorities(pid_t process) {
    std::vector<int> priorities;
    std::error_code gone;
    const auto tasks = "/proc/" + std::to_string(process) + "/task";
    for (auto it = std::filesystem::directory_iterator(tasks, gone); !gone && it != end(it);
         it.increment(gone)) {
        if (const Scheduling s = schedulingOf(it->path()); s.policy == SCHED_FIFO) {
            priorities.push_back(s.priority);
        }
    }
    return priorities;
}

} // namespace

TEST_CASE(
    "Where it is permitted, the haptic thread alone of a live run has real-time priority, and memory is "
    "locked") {
    if (!permitted()) {
        MESSAGE("SKIPPED: no real-time priority or locked memory is permitted here");
        return;
    }
    Stage stage;
    stage.recording(std::vector<Image>(10, bumpImage()));
    stage.scene({});
    stage.hand({{0.0, {0.0, 0.0, 0.4}}, {3.0, {0.0, 0.0, 0.45}}});
    const pid_t child = startFathom(stage.command({"--realtime", "--device", "llvmpipe"}), stage / "said");
    std::vector<int> priorities;
    long locked = 0;
    int status = 0;
    while (::waitpid(child, &status, WNOHANG) == 0) {
        const std::vector<int> now = realTimePriorities(child);
        priorities = now.size() > priorities.size() ? now : priorities;
        locked = std::max(locked, testing::lockedKiB(child));
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
    const std::string said = stage.read("said");
    CAPTURE(said);
    REQUIRE(WIFEXITED(status));
    CHECK(WEXITSTATUS(status) == 0);
    CHECK(said.find("refused") == std::string::npos);
    REQUIRE(priorities.size() == 1);
    CHECK(priorities[0] == 80);        // as fathom-limits.conf says
    CHECK((locked > 0 || kSanitized)); // under a sanitizer no memory is locked
}
