// SPDX-License-Identifier: Apache-2.0
// What a file that is written whole and then renamed may take the place of.
#pragma once

#include <filesystem>
#include <string>
#include <system_error>

namespace fathom {

// True where nothing is, and of a regular file; the name must not be the system's, either: /dev/stdout may
// lead to a file, but it is the link that would be replaced.
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
