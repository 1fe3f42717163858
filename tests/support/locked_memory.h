// SPDX-License-Identifier: Apache-2.0
// How much memory a process has locked.
#pragma once

#include <fstream>
#include <string>

#include <sys/types.h>

namespace fathom::testing {

// [KiB] 0 when the process is gone.
inline long lockedKiB(pid_t process) {
    std::ifstream file("/proc/" + std::to_string(process) + "/status");
    std::string word;
    long size = 0;
    while (file >> word && word != "VmLck:") {
    }
    return file >> size ? size : 0;
}

} // namespace fathom::testing
