// SPDX-License-Identifier: Apache-2.0
// Whether a path that a file names stays in that file's folder.
#pragma once

#include <filesystem>
#include <system_error>

namespace fathom {

// By its words alone: not absolute, and no more steps up than down.
inline bool staysInside(const std::filesystem::path& path) {
    const std::filesystem::path plain = path.lexically_normal();
    return !plain.is_absolute() && (plain.empty() || *plain.begin() != "..");
}

// By where the links on the way lead, as far as there is something there; the folder itself may be a link.
// True where that cannot be told: then the file cannot be opened either.
inline bool liesInside(const std::filesystem::path& file, const std::filesystem::path& folder) {
    namespace fs = std::filesystem;
    std::error_code noFile, noFolder;
    const fs::path home = fs::weakly_canonical(folder.empty() ? fs::path(".") : folder, noFolder);
    const fs::path real = fs::weakly_canonical(file, noFile);
    return noFile || noFolder || staysInside(real.lexically_relative(home));
}

} // namespace fathom
