// SPDX-License-Identifier: Apache-2.0
// Runs the built program as a child process, with Vulkan validation layers if configured
// (validation_wanted.h), and returns exit code, standard output and standard error.
#pragma once

#include <filesystem>
#include <string>
#include <sys/types.h>
#include <vector>

namespace fathom {

// The result of a finished program.
struct ProgramRun {
    int exitCode = -1; // -1 = ended by a signal or by the time limit
    std::string out, err;

    std::vector<std::string> errorLines() const; // lines of standard error
};

// How to start the program.
struct RunSetting {
    bool terminal = false;        // standard error is a pseudo-terminal instead of a pipe
    double timeLimit = 240.0;     // [s] then the child is killed
    std::filesystem::path folder; // working directory; empty = the test's own
    std::vector<int> closed;      // standard streams that are closed, such as STDOUT_FILENO

    // Runs as user nobody if the test is root; no real-time priority, 64 KiB of locked memory.
    bool unprivileged = false;
};

// Throws std::runtime_error when no child can be created. The child's standard input is empty.
ProgramRun runFathom(const std::vector<std::string>& arguments, const RunSetting& setting = {});

// Starts a child process, which the caller must wait for. Its output is appended to the file `said`, or goes
// to the test's own output. Throws std::runtime_error when no child can be created.
pid_t startFathom(const std::vector<std::string>& arguments, const std::filesystem::path& said = {});

// Whether the child handles SIGINT by itself. Until then the signal kills it.
bool handlesInterrupt(pid_t child);

// Sends the signal to a child, unless it is 0, and waits for its end. Its exit code; -1 = ended by a signal.
int exitCodeOf(pid_t child, int signal = 0);

// Sanitized programs started from now on ignore memory that third-party libraries never free
// (support/sanitizer_options.cpp).
void allowLibraryLeaks();

} // namespace fathom
