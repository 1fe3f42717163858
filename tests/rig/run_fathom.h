// SPDX-License-Identifier: Apache-2.0
// Starts the built program as a child, with the Vulkan layers where they are wanted (validation_wanted.h),
// and takes what it says: exit code, standard output, standard error.
#pragma once

#include <filesystem>
#include <string>
#include <sys/types.h>
#include <vector>

namespace fathom {

struct ProgramRun {
    int exitCode = -1; // -1 = it died of a signal or of our time limit
    std::string out, err;

    std::vector<std::string> errorLines() const; // of standard error, without line ends
};

struct RunSetting {
    bool terminal = false;        // standard error is a terminal (a pseudo one), not a pipe
    double timeLimit = 240.0;     // [s]; then the child is killed
    std::filesystem::path folder; // working folder; empty = ours
    bool unprivileged =
        false; // as user nobody when the test runs as root; no real-time priority, 64 KiB of locked memory
};

// Throws std::runtime_error when no child can be made. Its standard input is empty.
ProgramRun runFathom(const std::vector<std::string>& arguments, const RunSetting& setting = {});

// Starts it as a child process that the caller must wait for. Its output is appended to the file `said`, or
// goes to the test's own. Throws std::runtime_error when no child can be made.
pid_t startFathom(const std::vector<std::string>& arguments, const std::filesystem::path& said = {});

// Programs started from now on under a sanitizer ignore memory that third-party libraries keep until the
// process ends (support/sanitizer_options.cpp).
void allowLibraryLeaks();

} // namespace fathom
