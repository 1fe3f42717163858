// SPDX-License-Identifier: Apache-2.0
#include "apps/binding/arm_watchdog.h"

#include "apps/binding/own_process.h"
#include "devices/serial/line_watchdog.h"
#include "engine/types/error.h"

#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

namespace fathom {

namespace {

constexpr double kBeat = 0.1 * LineWatchdog::kSilence; // [s]
constexpr auto kPatience = std::chrono::seconds(1);    // time for it to end

} // namespace

std::string protocolName(SceneArm::Driver::Protocol protocol) {
    using Protocol = SceneArm::Driver::Protocol;
    return protocol == Protocol::ReachAlpha5   ? "reach_alpha5"
           : protocol == Protocol::ReachBravo7 ? "reach_bravo7"
                                               : "eca_5e";
}

ArmWatchdog::ArmWatchdog(const SerialPort& port, SceneArm::Driver::Protocol protocol) {
    int ends[2] = {-1, -1};
    int fault = ::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0, ends) == 0 ? 0 : errno;
    if (fault == 0) {
        socket_ = ends[0];
        const std::string name = protocolName(protocol);
        const char* words[] = {"fathom", kArmWatchdogCommand, name.c_str(), nullptr};
        std::array<int, kWatchdogLine + 1> files{kNullDevice, kNullDevice, STDERR_FILENO};
        files[kWatchdogEngine] = ends[1];
        files[kWatchdogLine] = port.descriptor();
        fault = startOwnProcess(process_, files, words);
        ::close(ends[1]);
    }
    if (fault != 0) {
        ::close(socket_);
        throw Error(std::string("no watchdog process for the arm: ") + std::strerror(fault));
    }
}

ArmWatchdog::~ArmWatchdog() {
    ::send(socket_, &kWatchdogGoodbye, 1, MSG_NOSIGNAL | MSG_DONTWAIT);
    ::close(socket_);
    if (!waitForEnd(process_, kPatience)) {
        ::kill(process_, SIGKILL);
        ::waitpid(process_, nullptr, 0);
    }
}

void ArmWatchdog::receive() noexcept {
    char bytes[64];
    ssize_t got = 0;
    while ((got = ::recv(socket_, bytes, sizeof bytes, MSG_DONTWAIT)) > 0) {
        ready_ = true; // it sends nothing else
        requestedAt_ = -1.0;
    }
    ended_ = ended_ || got == 0 || (errno != EAGAIN && errno != EINTR);
}

bool ArmWatchdog::stands(double now) noexcept {
    if (!ended_) {
        receive();
    }
    const bool silent = requestedAt_ >= 0.0 && now - requestedAt_ > kAnswerTimeout;
    return ready_ && !ended_ && !silent;
}

void ArmWatchdog::alive(double now) noexcept {
    if (now >= next_) {
        next_ = now + kBeat;
        requestedAt_ = requestedAt_ < 0.0 ? now : requestedAt_;
        ::send(socket_, &kWatchdogAlive, 1,
               MSG_NOSIGNAL | MSG_DONTWAIT); // a watchdog that hangs lets its socket fill up
    }
}

} // namespace fathom
