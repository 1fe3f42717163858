// SPDX-License-Identifier: Apache-2.0
#include "apps/clock/clock_keeper.h"

#include "apps/binding/own_process.h"
#include "engine/types/log.h"

#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <fcntl.h>
#include <poll.h>
#include <string>
#include <unistd.h>
#include <utility>

namespace fathom {

namespace {

constexpr auto kPatience = std::chrono::seconds(20); // a driver of many devices takes seconds
constexpr auto kExitTimeout = std::chrono::seconds(1);
constexpr auto kStep = std::chrono::milliseconds(5);

} // namespace

std::string hexOf(const std::array<uint8_t, 16>& uuid) {
    std::string text;
    for (const uint8_t byte : uuid) {
        text += {"0123456789abcdef"[byte >> 4], "0123456789abcdef"[byte & 15]};
    }
    return text;
}

ClockKeeper::ClockKeeper(const GlobalOptions& options, const DeviceFacts& device) {
    if (!options.holdClock || device.driver.empty()) { // or noDevice()
        return;
    }
    int life[2] = {-1, -1}, answer[2] = {-1, -1};
    int fault = ::pipe2(life, O_CLOEXEC) == 0 && ::pipe2(answer, O_CLOEXEC) == 0 ? 0 : errno;
    if (fault == 0) {
        const std::string id = hexOf(device.uuid);
        const int files[] = {life[0], answer[1], STDERR_FILENO};
        const char* words[] = {"fathom", kKeepClockCommand, id.c_str(), device.name.c_str(), nullptr};
        fault = startOwnProcess(process_, files, words);
    }
    ::close(life[0]);
    ::close(answer[1]);
    life_ = life[1];
    answer_ = answer[0];
    if (fault != 0) {
        process_ = -1;
        log::warn("--hold-clock: cannot lock the clock of '{}': {}", device.name, std::strerror(fault));
    }
}

ClockKeeper::~ClockKeeper() {
    end();
}

// The process holds no state, so it is killed. If even SIGKILL blocks in the driver, init reaps it.
void ClockKeeper::end() noexcept {
    ::close(std::exchange(life_, -1));
    ::close(std::exchange(answer_, -1));
    held_ = false;
    const pid_t process = std::exchange(process_, -1);
    if (process > 0 && !waitForEnd(process, kExitTimeout)) {
        ::kill(process, SIGKILL);
        waitForEnd(process, kStep);
    }
}

bool ClockKeeper::held() noexcept {
    const auto until = std::chrono::steady_clock::now() + kPatience;
    char byte = 0;
    while (process_ > 0) {
        pollfd waited{answer_, POLLIN, 0};
        const int ready = ::poll(&waited, 1, held_ ? 0 : static_cast<int>(kStep.count()));
        if (ready > 0 && (waited.revents & POLLIN) != 0 && ::read(answer_, &byte, 1) == 1) {
            held_ = held_ || byte == kClockHeld;
        } else if (ready > 0 || (!held_ && std::chrono::steady_clock::now() > until)) {
            end(); // it has ended or does not answer
        } else if (held_) {
            break;
        }
    }
    return held_;
}

} // namespace fathom
