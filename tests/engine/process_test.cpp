// SPDX-License-Identifier: Apache-2.0
// An engine and the process around it: drivers that are missing, signals, forked children.
#include "tests/engine/wall_world.h"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <doctest/doctest.h>
#include <filesystem>
#include <fstream>
#include <map>
#include <memory>
#include <string>
#include <sys/wait.h>
#include <unistd.h>

using namespace fathom;
using namespace fathom::testing;

namespace {

// Blocked signals of each thread of this process that has the program's name, as drivers' threads have not;
// bit n - 1 is signal n.
std::map<std::string, unsigned long long> blockedByThread() {
    std::map<std::string, unsigned long long> masks;
    std::string program;
    std::getline(std::ifstream("/proc/self/comm"), program);
    for (const auto& thread : std::filesystem::directory_iterator("/proc/self/task")) {
        std::ifstream names(thread.path() / "comm"), status(thread.path() / "status");
        std::string line;
        std::getline(names, line);
        const bool ours = line == program;
        while (ours && std::getline(status, line)) {
            if (line.rfind("SigBlk:", 0) == 0) {
                masks[thread.path().filename()] = std::stoull(line.substr(7), nullptr, 16);
            }
        }
    }
    return masks;
}

} // namespace

TEST_CASE("Without a Vulkan driver engine and lockstep say in one line that the compute device is missing") {
    const Scene scene = wallScene();
    ::setenv("VK_DRIVER_FILES", "/nonexistent/driver.json", 1);
    const char* const line =
        "device: Vulkan driver: none is installed (allowed: a Vulkan 1.2 driver: install your "
        "GPU's, or mesa-vulkan-drivers, which also runs on the CPU)";
    CHECK_THROWS_WITH_AS(Engine(scene, smallCamera()), line, ComputeDeviceLost);
    CHECK_THROWS_WITH_AS(Lockstep(scene, smallCamera(), startAt(0.5)), line, ComputeDeviceLost);
    CHECK_NOTHROW(Engine(boxScene(), smallCamera())); // needs none
    ::unsetenv("VK_DRIVER_FILES");
    CHECK_NOTHROW(Engine(scene, smallCamera()));
}

TEST_CASE("The threads of an engine block the signals of the program, and its own thread stays as it was") {
    const auto before = blockedByThread();
    const Engine engine(wallScene(), smallCamera());
    const auto now = blockedByThread();
    int added = 0;
    for (const auto& [thread, mask] : now) {
        if (const auto known = before.find(thread); known != before.end()) {
            CHECK(mask == known->second);
            continue;
        }
        ++added;
        for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGUSR1, SIGALRM, SIGCHLD, SIGPIPE}) {
            CHECK((mask >> (signal - 1) & 1) == 1);
        }
    }
    CHECK(added >= 3); // frames, contacts, clearance
}
