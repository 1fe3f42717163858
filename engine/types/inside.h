// SPDX-License-Identifier: Apache-2.0
// Whether a path that a file names stays in that file's folder.
#pragma once

#include <filesystem>

namespace fathom {

// By its words alone: not absolute, and no more steps up than down. Links in the folder itself are its
// owner's doing.
inline bool staysInside(const std::filesystem::path& path) {
    const std::filesystem::path plain = path.lexically_normal();
    return !plain.is_absolute() && (plain.empty() || *plain.begin() != "..");
}

} // namespace fathom
