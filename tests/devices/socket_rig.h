// SPDX-License-Identifier: Apache-2.0
// Scratch folder, packets and child processes for tests of the socket.
#pragma once

#include "devices/bridge/socket_server.h"
#include "tests/support/eventually.h"
#include "tests/support/scratch_folder.h"

#include <chrono>
#include <doctest/doctest.h>
#include <filesystem>
#include <functional>
#include <thread>

#include <csignal>
#include <sys/wait.h>
#include <unistd.h>

namespace fathom::testing {

struct SocketFolder : ScratchFolder {
    std::filesystem::path endpoint() const { return path() / "test.door"; }
};

inline SocketServer::Options serverAt(const std::filesystem::path& path) {
    return {path, "falcon", "test device", 8.0, 0.2};
}

inline fathom_door_wrench wrenchPacket(uint64_t sequence, double fx) {
    fathom_door_wrench packet{};
    packet.header = socketHeader(FATHOM_DOOR_WRENCH, sizeof packet, sequence);
    packet.flags = FATHOM_DOOR_FORCES_ON;
    packet.force[0] = fx;
    return packet;
}

inline fathom_door_hand handPacket(uint64_t sequence, double x) {
    fathom_door_hand packet{};
    packet.header = socketHeader(FATHOM_DOOR_HAND, sizeof packet, sequence);
    packet.status = FATHOM_DOOR_PRESENT | FATHOM_DOOR_HOMED;
    packet.position[0] = x;
    packet.orientation[0] = 1.0;
    packet.preset[0] = 'x';
    return packet;
}

inline void pauseMs(int ms) {
    std::this_thread::sleep_for(std::chrono::milliseconds(ms));
}

// A child process that runs `body` and exits with its result. Killed by the destructor at the latest.
class Child {
public:
    explicit Child(const std::function<int()>& body)
        : id_(::fork()) {
        REQUIRE(id_ >= 0);
        if (id_ == 0) {
            int result = 99;
            try {
                result = body();
            } catch (...) {
            }
            ::_exit(result);
        }
    }
    Child(const Child&) = delete;
    Child& operator=(const Child&) = delete;
    ~Child() {
        if (id_ > 0) {
            signal(SIGKILL);
            wait();
        }
    }
    void signal(int number) const { ::kill(id_, number); }
    // Exit code, or minus the signal.
    int wait() {
        int status = 0;
        ::waitpid(id_, &status, 0);
        id_ = -1;
        return WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
    }

private:
    pid_t id_;
};

} // namespace fathom::testing
