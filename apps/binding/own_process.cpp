// SPDX-License-Identifier: Apache-2.0
#include "apps/binding/own_process.h"

#include <cerrno>
#include <csignal>
#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>

extern char** environ;

namespace fathom {

namespace {

constexpr int kAbove = 10;            // lowest number of the copies, above all target numbers
constexpr size_t kMaxDescriptors = 8; // descriptors per child

// Inherited descriptors have no FD_CLOEXEC. Ours have it, and one may have the number of a standard error
// that was closed.
bool hasStandardError() noexcept {
    const int flags = ::fcntl(STDERR_FILENO, F_GETFD);
    return flags >= 0 && (flags & FD_CLOEXEC) == 0;
}

// The child's descriptors, copied above its target numbers and closed here afterwards.
class Actions {
public:
    explicit Actions(std::span<const int> files) noexcept {
        ::posix_spawn_file_actions_init(&actions);
        for (const int file : files) {
            const int place = static_cast<int>(count_);
            if (file == kNullDevice || (file == STDERR_FILENO && !hasStandardError())) {
                copies_[count_++] = -1;
                ::posix_spawn_file_actions_addopen(&actions, place, "/dev/null", O_RDWR, 0);
                continue;
            }
            const int copy = ::fcntl(file, F_DUPFD_CLOEXEC, kAbove);
            fault = copy < 0 && fault == 0 ? errno : fault;
            copies_[count_++] = copy;
            ::posix_spawn_file_actions_adddup2(&actions, copy, place);
        }
        ::posix_spawn_file_actions_addclosefrom_np(&actions, static_cast<int>(count_));
    }
    ~Actions() {
        ::posix_spawn_file_actions_destroy(&actions);
        for (size_t i = 0; i < count_; ++i) {
            ::close(copies_[i]);
        }
    }
    Actions(const Actions&) = delete;
    Actions& operator=(const Actions&) = delete;

    posix_spawn_file_actions_t actions;
    int fault = 0;

private:
    int copies_[kMaxDescriptors];
    size_t count_ = 0;
};

} // namespace

int startOwnProcess(pid_t& process, std::span<const int> files, std::span<const char* const> words) noexcept {
    if (files.size() > kMaxDescriptors) {
        return EINVAL;
    }
    const Actions given(files);
    if (given.fault != 0) {
        return given.fault;
    }
    posix_spawnattr_t how;
    ::posix_spawnattr_init(&how);
    sigset_t none, all;
    ::sigemptyset(&none);
    ::sigfillset(&all);
    ::posix_spawnattr_setsigmask(&how, &none);
    ::posix_spawnattr_setsigdefault(&how, &all);
    ::posix_spawnattr_setflags(&how, POSIX_SPAWN_SETSID | POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF);
    const int fault = ::posix_spawn(&process, "/proc/self/exe", &given.actions, &how,
                                    const_cast<char* const*>(words.data()), environ);
    ::posix_spawnattr_destroy(&how);
    return fault;
}

bool waitForEnd(pid_t process, std::chrono::milliseconds timeout) noexcept {
    constexpr auto kPollPeriod = std::chrono::milliseconds(1);
    const auto until = std::chrono::steady_clock::now() + timeout;
    while (::waitpid(process, nullptr, WNOHANG) == 0) {
        if (std::chrono::steady_clock::now() > until) {
            return false;
        }
        std::this_thread::sleep_for(kPollPeriod);
    }
    return true;
}

} // namespace fathom
