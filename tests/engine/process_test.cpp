// SPDX-License-Identifier: Apache-2.0
// An engine and the process around it: drivers that are missing, signals, forked children.
#include "tests/engine/wall_world.h"

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
            if (line.starts_with("SigBlk:")) {
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

#ifndef FATHOM_SANITIZED // sanitizers look for leaks in the child

namespace {

// Not the driver of a GPU, whose own exit handlers may not expect a fork.
const EngineOptions kOnCpu{"llvmpipe", "", false};

// Status of a child that runs `body` and then exits, as waitpid() gives it.
template <class Body>
int statusOfChild(Body&& body) {
    std::fflush(nullptr);
    const pid_t child = ::fork();
    if (child == 0) {
        ::alarm(60);
        body();
        std::exit(0);
    }
    int status = -1;
    REQUIRE(::waitpid(child, &status, 0) == child);
    return status;
}

} // namespace

TEST_CASE("A forked child that exits, or destroys its copy of an engine, leaves the engine to its parent") {
    static auto engine = std::make_unique<Engine>(wallScene(), smallCamera(), kOnCpu);
    CHECK(statusOfChild([] {}) == 0); // destroys what is static
    CHECK(statusOfChild([] { engine.reset(); }) == 0);
    CameraPort port = engine->camera();
    const Wall wall;
    CHECK(port.submit(wall.at(now())) == SubmitStatus::Accepted);
    CHECK(eventually([&] { return port.processed() == 1; }));
    engine.reset();
}

TEST_CASE("A forked child that destroys its copy of a lockstep run leaves the run to its parent") {
    auto lockstep = std::make_unique<Lockstep>(wallScene(), smallCamera(), startAt(0.5), kOnCpu);
    CHECK(statusOfChild([&] { lockstep.reset(); }) == 0);
    const Wall wall;
    CHECK_NOTHROW(lockstep->process(wall.at(1)));
}

#endif
