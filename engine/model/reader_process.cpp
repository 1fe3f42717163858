// SPDX-License-Identifier: Apache-2.0
#include "engine/model/reader_process.h"

#include "engine/types/error.h"

#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <thread>
#include <vector>

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

namespace fathom {

namespace {

constexpr const char* kProgram = "fathom-reader";

// The mapped file that contains this function: the program, or libfathom.so.
std::filesystem::path ownFile() {
    const auto here = reinterpret_cast<uintptr_t>(&ownFile);
    std::ifstream maps("/proc/self/maps");
    for (std::string line; std::getline(maps, line);) {
        std::istringstream in(line);
        uintptr_t first = 0, last = 0;
        char dash = 0;
        std::string rights, offset, device, inode, path;
        in >> std::hex >> first >> dash >> last >> rights >> offset >> device >> inode >> std::ws;
        if (in && here >= first && here < last && std::getline(in, path)) {
            return path;
        }
    }
    return {};
}

class Pipe {
public:
    explicit Pipe(const std::string& program) {
        if (::pipe2(ends_.data(), O_CLOEXEC) != 0) {
            throw Error(program + ": no pipe: " + std::strerror(errno));
        }
    }
    ~Pipe() {
        ::close(ends_[0]);
        closeWriter();
    }
    Pipe(const Pipe&) = delete;
    Pipe& operator=(const Pipe&) = delete;
    void closeWriter() {
        if (ends_[1] >= 0) {
            ::close(ends_[1]);
        }
        ends_[1] = -1;
    }
    int reader() const { return ends_[0]; }
    int writer() const { return ends_[1]; }

private:
    std::array<int, 2> ends_{-1, -1};
};

// Standard output is the pipe; nothing else of this process is passed on.
class Files {
public:
    explicit Files(int output) {
        ::posix_spawn_file_actions_init(&actions_);
        ::posix_spawn_file_actions_adddup2(&actions_, output, STDOUT_FILENO);
        ::posix_spawn_file_actions_addopen(&actions_, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
#ifndef FATHOM_SANITIZED
        ::posix_spawn_file_actions_addopen(&actions_, STDERR_FILENO, "/dev/null", O_WRONLY, 0);
#endif
        ::posix_spawn_file_actions_addclosefrom_np(&actions_, STDERR_FILENO + 1);
    }
    ~Files() {
        ::posix_spawn_file_actions_destroy(&actions_);
    }
    Files(const Files&) = delete;
    Files& operator=(const Files&) = delete;
    const posix_spawn_file_actions_t* get() const {
        return &actions_;
    }

private:
    posix_spawn_file_actions_t actions_;
};

// Default actions and an empty mask, whatever the calling thread blocks or ignores.
class Signals {
public:
    Signals() {
        sigset_t none, all;
        ::sigemptyset(&none);
        ::sigfillset(&all);
        ::posix_spawnattr_init(&attributes_);
        ::posix_spawnattr_setsigmask(&attributes_, &none);
        ::posix_spawnattr_setsigdefault(&attributes_, &all);
        ::posix_spawnattr_setflags(&attributes_, POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF);
    }
    ~Signals() { ::posix_spawnattr_destroy(&attributes_); }
    Signals(const Signals&) = delete;
    Signals& operator=(const Signals&) = delete;
    const posix_spawnattr_t* get() const { return &attributes_; }

private:
    posix_spawnattr_t attributes_;
};

pid_t spawn(const std::string& program, const std::vector<std::string>& arguments, int output) {
    std::vector<char*> texts;
    for (const std::string& argument : arguments) {
        texts.push_back(const_cast<char*>(argument.c_str()));
    }
    texts.push_back(nullptr);
    const Files files(output);
    const Signals signals;
    pid_t process = 0;
    const int fault =
        ::posix_spawn(&process, program.c_str(), files.get(), signals.get(), texts.data(), environ);
    if (fault != 0) {
        throw Error(program + ": cannot be started: " + std::strerror(fault) + " (allowed: the program " +
                    kProgram + " of this version)");
    }
    return process;
}

// Waits until the process has ended or its time is over, then kills it. Status 0 if another part of this
// program has collected it.
int awaitEnd(pid_t process, ReaderPipe::Time until) {
    int status = 0;
    for (;;) {
        const pid_t ended = ::waitpid(process, &status, WNOHANG);
        if (ended == process || (ended < 0 && errno != EINTR)) {
            return ended == process ? status : 0;
        }
        if (ReaderPipe::Time::clock::now() >= until) {
            ::kill(process, SIGKILL);
        }
        std::this_thread::sleep_for(std::chrono::microseconds(200));
    }
}

} // namespace

std::filesystem::path readerProgram() {
    const std::filesystem::path folder = ownFile().parent_path();
    for (const char* below : {"", "../libexec/fathom", "../../libexec/fathom"}) {
        const auto program = (folder / below / kProgram).lexically_normal();
        if (std::error_code ignored; std::filesystem::is_regular_file(program, ignored)) {
            return program;
        }
    }
    throw Error(std::string(kProgram) + ": not found for " + folder.string() +
                " (allowed: in that folder, ../libexec/fathom or ../../libexec/fathom)");
}

ReaderEnd runReader(const std::string& kind, const std::filesystem::path& file, const ReaderOptions& options,
                    const std::function<bool(ReaderPipe&)>& take) {
    const std::string program = options.program.empty() ? readerProgram() : options.program;
    Pipe pipe(program);
    const pid_t process =
        spawn(program, {kProgram, kind, file.string(), std::to_string(options.mostMemory)}, pipe.writer());
    pipe.closeWriter();
    const auto until = ReaderPipe::Time::clock::now() + options.patience;
    ReaderPipe answer(pipe.reader(), until);
    std::string mark(kReaderMark.size(), ' ');
    ReaderEnd end;
    const bool marked = answer.read(mark.data(), mark.size()) && mark == kReaderMark;
    end.whole = marked && take(answer);
    const bool running = !end.whole && !answer.ended(); // its answer is too late or out of bounds
    const int status = awaitEnd(process, running ? ReaderPipe::Time{} : until);
    if (WIFEXITED(status) && WEXITSTATUS(status) == kSanitizerReport) {
        throw std::logic_error(file.string() + ": a sanitizer ended its reader in Fathom's own code");
    }
    end.late = answer.late();
    end.signal = !running && WIFSIGNALED(status) ? WTERMSIG(status) : 0;
    end.foreign = !marked && !end.late && end.signal == 0;
    return end;
}

void refuseForeign(const ReaderOptions& options, const ReaderEnd& end) {
    if (!end.foreign) {
        return;
    }
    const std::string allowed = std::string("the program ") + kProgram + " of this version";
    if (!options.program.empty()) {
        throw BadInput("options", "reader", options.program.string(),
                       allowed + "; empty = the installed one");
    }
    throw Error(readerProgram().string() + ": another program (allowed: " + allowed + ")");
}

std::string broken(const std::string& reader, const ReaderEnd& end) {
    if (end.late) {
        return "takes too long for the " + reader;
    }
    return "breaks the " + reader +
           (end.signal != 0 ? " (signal " + std::to_string(end.signal) + ")" : std::string());
}

} // namespace fathom
