// SPDX-License-Identifier: Apache-2.0
// Checks whether a file that is written completely and then renamed may replace what has that name.
#pragma once

#include <filesystem>
#include <system_error>

namespace fathom {

// True if the name is free or a regular file. False for system names: /dev/stdout may lead to a file, but
// renaming would replace the link.
inline bool isReplaceable(const std::filesystem::path& file) {
    namespace fs = std::filesystem;
    std::error_code unknown;
    const fs::file_status there = fs::status(file, unknown);
    if (fs::exists(there) && !fs::is_regular_file(there)) {
        return false;
    }
    const fs::path folder = fs::weakly_canonical(fs::absolute(file, unknown).parent_path(), unknown);
    return folder != "/dev" && folder.string().rfind("/proc/", 0) != 0;
}

} // namespace fathom
