// SPDX-License-Identifier: Apache-2.0
#include "apps/binding/arm_guardian.h"

#include "devices/serial/line_guard.h"
#include "engine/types/error.h"

#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <fcntl.h>
#include <spawn.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>

extern char** environ;

namespace fathom {

namespace {

constexpr double kBeat = 0.1 * LineGuard::kSilence; // [s]
constexpr auto kPatience = std::chrono::seconds(1); // with one that does not end
constexpr int kAbove = 10;                          // descriptors that no action of the child overwrites

struct Above { // a copy that the child's places do not hit
    explicit Above(int file)
        : value(::fcntl(file, F_DUPFD_CLOEXEC, kAbove)) {}
    ~Above() { ::close(value); }
    int value;
};

// Nothing of the engine's but the two: a guardian must not keep a camera or a GPU open. A session of its own:
// Ctrl-C and a closed terminal are the engine's. Returns errno's number.
int spawn(pid_t& process, int engine, int line, const char* protocol) {
    const Above socket(engine), port(line);
    posix_spawn_file_actions_t files;
    posix_spawnattr_t how;
    ::posix_spawn_file_actions_init(&files);
    ::posix_spawnattr_init(&how);
    ::posix_spawn_file_actions_addopen(&files, 0, "/dev/null", O_RDWR, 0);
    ::posix_spawn_file_actions_adddup2(&files, 0, 1);
    ::posix_spawn_file_actions_adddup2(&files, socket.value, kGuardianEngine);
    ::posix_spawn_file_actions_adddup2(&files, port.value, kGuardianLine);
    ::posix_spawn_file_actions_addclosefrom_np(&files, kGuardianLine + 1);
    sigset_t none, all;
    ::sigemptyset(&none);
    ::sigfillset(&all);
    ::posix_spawnattr_setsigmask(&how, &none);
    ::posix_spawnattr_setsigdefault(&how, &all);
    ::posix_spawnattr_setflags(&how, POSIX_SPAWN_SETSID | POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF);
    const char* words[] = {"fathom", kArmGuardianCommand, protocol, nullptr};
    const int fault =
        ::posix_spawn(&process, "/proc/self/exe", &files, &how, const_cast<char* const*>(words), environ);
    ::posix_spawnattr_destroy(&how);
    ::posix_spawn_file_actions_destroy(&files);
    return fault;
}

} // namespace

std::string protocolName(SceneArm::Driver::Protocol protocol) {
    return protocol == SceneArm::Driver::Protocol::ReachAlpha5 ? "reach_alpha5" : "eca_5e";
}

ArmGuardian::ArmGuardian(const SerialPort& port, SceneArm::Driver::Protocol protocol) {
    int ends[2] = {-1, -1};
    int fault = ::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0, ends) == 0 ? 0 : errno;
    if (fault == 0) {
        socket_ = ends[0];
        fault = spawn(process_, ends[1], port.descriptor(), protocolName(protocol).c_str());
        ::close(ends[1]);
    }
    if (fault != 0) {
        ::close(socket_);
        throw Error(std::string("no guardian for the arm: ") + std::strerror(fault));
    }
}

ArmGuardian::~ArmGuardian() {
    ::send(socket_, &kGuardFarewell, 1, MSG_NOSIGNAL | MSG_DONTWAIT);
    ::close(socket_);
    const auto until = std::chrono::steady_clock::now() + kPatience;
    while (::waitpid(process_, nullptr, WNOHANG) == 0) {
        if (std::chrono::steady_clock::now() > until) {
            ::kill(process_, SIGKILL);
            ::waitpid(process_, nullptr, 0);
            return;
        }
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
}

void ArmGuardian::hear() noexcept {
    char byte = 0;
    const ssize_t got = ::recv(socket_, &byte, 1, MSG_DONTWAIT);
    ready_ = ready_ || (got == 1 && byte == kGuardReady);
    ended_ = ended_ || got == 0 || (got < 0 && errno != EAGAIN && errno != EINTR);
}

bool ArmGuardian::stands() noexcept {
    if (!ended_) {
        hear();
    }
    return ready_ && !ended_;
}

void ArmGuardian::alive(double now) noexcept {
    if (now >= next_) {
        next_ = now + kBeat;
        ::send(socket_, &kGuardAlive, 1,
               MSG_NOSIGNAL | MSG_DONTWAIT); // a guardian that hangs fills its socket
    }
}

} // namespace fathom
