// SPDX-License-Identifier: Apache-2.0
#include "tests/rig/run_fathom.h"

#include "tests/support/validation_wanted.h"

#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <fcntl.h>
#include <fstream>
#include <grp.h>
#include <poll.h>
#include <stdexcept>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

namespace fathom {

namespace {

struct Descriptor {
    int value = -1;
    ~Descriptor() { reset(); }
    void reset() {
        if (value >= 0) {
            ::close(value);
        }
        value = -1;
    }
};

// A pipe: the child writes to `write`, the test reads from `read`.
struct Channel {
    Descriptor read, write;

    explicit Channel(bool terminal) {
        int ends[2] = {-1, -1};
        if (terminal) {
            read.value = ::posix_openpt(O_RDWR | O_NOCTTY | O_CLOEXEC);
            if (read.value < 0 || ::grantpt(read.value) != 0 || ::unlockpt(read.value) != 0) {
                throw std::runtime_error("the test gets no pseudo terminal");
            }
            write.value = ::open(::ptsname(read.value), O_RDWR | O_NOCTTY | O_CLOEXEC);
        } else if (::pipe2(ends, O_CLOEXEC) == 0) {
            read.value = ends[0];
            write.value = ends[1];
        }
        if (write.value < 0) {
            throw std::runtime_error("the test gets no channel to its child");
        }
    }
};

constexpr unsigned kNobody = 65534;

bool dropPrivileges() {
    const rlimit priority{0, 0}, memory{64 << 10, 64 << 10};
    return ::setrlimit(RLIMIT_RTPRIO, &priority) == 0 && ::setrlimit(RLIMIT_MEMLOCK, &memory) == 0 &&
           (::getuid() != 0 ||
            (::setgroups(0, nullptr) == 0 && ::setgid(kNobody) == 0 && ::setuid(kNobody) == 0));
}

// Allocates everything before the fork: in the child the allocator may stay locked by another thread or by a
// sanitizer.
class Command {
public:
    explicit Command(const std::vector<std::string>& arguments)
        : words_{FATHOM_PROGRAM} {
        if (testing::validationWanted()) {
            words_.push_back("--validate");
        }
        words_.insert(words_.end(), arguments.begin(), arguments.end());
        for (std::string& word : words_) {
            pointers_.push_back(word.data());
        }
        pointers_.push_back(nullptr);
        allowLibraryLeaks();
    }
    Command(const Command&) = delete;
    Command& operator=(const Command&) = delete;

    [[noreturn]] void become(const RunSetting& setting, int out, int err) const {
        const int nothing = ::open("/dev/null", O_RDONLY);
        const bool ready = ::dup2(nothing, 0) >= 0 && ::dup2(out, 1) >= 0 && ::dup2(err, 2) >= 0 &&
                           (setting.folder.empty() || ::chdir(setting.folder.c_str()) == 0) &&
                           (!setting.unprivileged || dropPrivileges());
        for (const int stream : setting.closed) {
            ::close(stream);
        }
        if (ready) {
            ::execv(pointers_[0], pointers_.data());
        }
        ::_exit(126);
    }

private:
    std::vector<std::string> words_;
    std::vector<char*> pointers_;
};

// Reads both channels to their ends. False when the time limit is reached first.
bool drain(Channel& out, Channel& err, ProgramRun& run, double limit) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(limit);
    std::string* texts[2] = {&run.out, &run.err};
    pollfd watched[2] = {{out.read.value, POLLIN, 0}, {err.read.value, POLLIN, 0}};
    int open = 2;
    while (open > 0) {
        if (std::chrono::steady_clock::now() >= end) {
            return false;
        }
        if (::poll(watched, 2, 200) <= 0) {
            continue;
        }
        for (int i = 0; i < 2; ++i) {
            if (watched[i].fd < 0 || watched[i].revents == 0) {
                continue;
            }
            char bytes[1 << 16];
            const ssize_t count = ::read(watched[i].fd, bytes, sizeof bytes);
            if (count > 0) {
                texts[i]->append(bytes, static_cast<size_t>(count));
            } else if (count == 0 || errno != EINTR) { // EIO: the other end is closed
                watched[i].fd = -1;
                --open;
            }
        }
    }
    return true;
}

} // namespace

std::vector<std::string> ProgramRun::errorLines() const {
    std::vector<std::string> lines;
    for (size_t begin = 0; begin < err.size();) {
        const size_t end = std::min(err.find('\n', begin), err.size());
        lines.push_back(err.substr(begin, end - begin));
        begin = end + 1;
    }
    return lines;
}

void allowLibraryLeaks() {
    const std::string leaks = std::filesystem::absolute("tests/rig/leaks.supp").string();
    ::setenv("LSAN_OPTIONS", ("print_suppressions=0:suppressions=" + leaks).c_str(), 0);
}

pid_t startFathom(const std::vector<std::string>& arguments, const std::filesystem::path& said) {
    const Descriptor file{
        said.empty() ? -1 : ::open(said.c_str(), O_CREAT | O_WRONLY | O_APPEND | O_CLOEXEC, 0644)};
    if (!said.empty() && file.value < 0) {
        throw std::runtime_error("the test cannot write " + said.string());
    }
    const Command command(arguments);
    const RunSetting setting;
    const pid_t child = ::fork();
    if (child < 0) {
        throw std::runtime_error("the test cannot start a child");
    }
    if (child == 0) {
        command.become(setting, said.empty() ? 1 : file.value, said.empty() ? 2 : file.value);
    }
    return child;
}

ProgramRun runFathom(const std::vector<std::string>& arguments, const RunSetting& setting) {
    Channel out(false), err(setting.terminal);
    const Command command(arguments);
    const pid_t child = ::fork();
    if (child < 0) {
        throw std::runtime_error("the test cannot start a child");
    }
    if (child == 0) {
        command.become(setting, out.write.value, err.write.value);
    }
    out.write.reset();
    err.write.reset();
    ProgramRun run;
    if (!drain(out, err, run, setting.timeLimit)) {
        ::kill(child, SIGKILL);
        run.err += "\nthe test's time limit";
    }
    run.exitCode = exitCodeOf(child);
    return run;
}

bool handlesInterrupt(pid_t child) {
    const std::filesystem::path folder = "/proc/" + std::to_string(child);
    std::error_code gone;
    if (!std::filesystem::equivalent(folder / "exe", FATHOM_PROGRAM, gone)) {
        return false; // still the test's own process
    }
    std::ifstream status(folder / "status");
    std::string word;
    while (status >> word && word != "SigCgt:") {
    }
    status >> word;
    return ((std::strtoull(word.c_str(), nullptr, 16) >> (SIGINT - 1)) & 1) != 0;
}

int exitCodeOf(pid_t child, int signal) {
    ::kill(child, signal);
    int status = 0;
    while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
    }
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

} // namespace fathom
