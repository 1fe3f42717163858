// SPDX-License-Identifier: Apache-2.0
// Checks whether a path named in a file stays inside that file's folder.
#pragma once

#include <filesystem>
#include <system_error>

namespace fathom {

// Checks the text only: the path is relative and never leads above the folder.
inline bool staysInside(const std::filesystem::path& path) {
    const std::filesystem::path plain = path.lexically_normal();
    return !plain.is_absolute() && (plain.empty() || *plain.begin() != "..");
}

// Follows symbolic links as far as the path exists; the folder itself may be a link. True if this fails,
// because then the file cannot be opened either.
inline bool liesInside(const std::filesystem::path& file, const std::filesystem::path& folder) {
    namespace fs = std::filesystem;
    std::error_code noFile, noFolder;
    const fs::path home = fs::weakly_canonical(folder.empty() ? fs::path(".") : folder, noFolder);
    const fs::path real = fs::weakly_canonical(file, noFile);
    return noFile || noFolder || staysInside(real.lexically_relative(home));
}

} // namespace fathom
