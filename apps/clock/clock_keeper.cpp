// SPDX-License-Identifier: Apache-2.0
#include "apps/clock/clock_keeper.h"

#include "engine/types/log.h"

#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <string>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>
#include <utility>

extern char** environ;

namespace fathom {

namespace {

constexpr auto kPatience = std::chrono::seconds(20); // a driver of many devices takes seconds
constexpr auto kFarewell = std::chrono::seconds(1);
constexpr auto kStep = std::chrono::milliseconds(5);

// Ctrl-C is the engine's: the clock is held until that ends. Returns errno's number.
int spawn(pid_t& process, int life, int answer, const std::string& id, const std::string& name) noexcept {
    posix_spawn_file_actions_t files;
    posix_spawnattr_t how;
    ::posix_spawn_file_actions_init(&files);
    ::posix_spawnattr_init(&how);
    ::posix_spawn_file_actions_adddup2(&files, life, STDIN_FILENO);
    ::posix_spawn_file_actions_adddup2(&files, answer, STDOUT_FILENO);
    ::posix_spawn_file_actions_addclosefrom_np(&files, STDERR_FILENO + 1);
    sigset_t none, all;
    ::sigemptyset(&none);
    ::sigfillset(&all);
    ::posix_spawnattr_setsigmask(&how, &none);
    ::posix_spawnattr_setsigdefault(&how, &all);
    ::posix_spawnattr_setflags(&how, POSIX_SPAWN_SETSID | POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF);
    const char* words[] = {"fathom", kKeepClockCommand, id.c_str(), name.c_str(), nullptr};
    const int fault =
        ::posix_spawn(&process, "/proc/self/exe", &files, &how, const_cast<char* const*>(words), environ);
    ::posix_spawnattr_destroy(&how);
    ::posix_spawn_file_actions_destroy(&files);
    return fault;
}

} // namespace

std::string hexOf(const std::array<uint8_t, 16>& uuid) {
    std::string text;
    for (const uint8_t byte : uuid) {
        text += {"0123456789abcdef"[byte >> 4], "0123456789abcdef"[byte & 15]};
    }
    return text;
}

ClockKeeper::ClockKeeper(const GlobalOptions& options, const DeviceFacts& device) {
    if (!options.holdClock) {
        return;
    }
    int life[2] = {-1, -1}, answer[2] = {-1, -1};
    int fault = ::pipe2(life, O_CLOEXEC) == 0 && ::pipe2(answer, O_CLOEXEC) == 0 ? 0 : errno;
    if (fault == 0) {
        fault = spawn(process_, life[0], answer[1], hexOf(device.uuid), device.name);
    }
    ::close(life[0]);
    ::close(answer[1]);
    life_ = life[1], answer_ = answer[0];
    if (fault != 0) {
        process_ = -1;
        log::warn("--hold-clock: the clock of '{}' is not held: {}", device.name, std::strerror(fault));
    }
}

ClockKeeper::~ClockKeeper() {
    end();
}

// It holds nothing that must be put in order. Where even SIGKILL waits for the driver, init gets it.
void ClockKeeper::end() noexcept {
    ::close(std::exchange(life_, -1));
    ::close(std::exchange(answer_, -1));
    held_ = false;
    const pid_t process = std::exchange(process_, -1);
    const auto until = std::chrono::steady_clock::now() + kFarewell;
    while (process > 0 && ::waitpid(process, nullptr, WNOHANG) == 0) {
        if (std::chrono::steady_clock::now() > until) {
            ::kill(process, SIGKILL);
            std::this_thread::sleep_for(kStep);
            ::waitpid(process, nullptr, WNOHANG);
            return;
        }
        std::this_thread::sleep_for(kStep);
    }
}

bool ClockKeeper::held() noexcept {
    const auto until = std::chrono::steady_clock::now() + kPatience;
    char byte = 0;
    while (process_ > 0) {
        pollfd waited{answer_, POLLIN, 0};
        const int told = ::poll(&waited, 1, held_ ? 0 : static_cast<int>(kStep.count()));
        if (told > 0 && (waited.revents & POLLIN) != 0 && ::read(answer_, &byte, 1) == 1) {
            held_ = held_ || byte == kClockHeld;
        } else if (told > 0 || (!held_ && std::chrono::steady_clock::now() > until)) {
            end(); // it has ended, or says nothing
        } else if (held_) {
            break;
        }
    }
    return held_;
}

} // namespace fathom
