// SPDX-License-Identifier: Apache-2.0
// Where files are kept that can be made again.
#pragma once

#include <cstdlib>
#include <filesystem>

namespace fathom {

// $XDG_CACHE_HOME/fathom, else ~/.cache/fathom; empty without both. By the XDG Base Directory Specification
// an empty or relative path counts as not set.
inline std::filesystem::path cacheFolder() {
    const char *cache = std::getenv("XDG_CACHE_HOME"), *home = std::getenv("HOME");
    const std::filesystem::path base(cache != nullptr ? cache : "");
    if (base.is_absolute()) {
        return base / "fathom";
    }
    return home != nullptr && *home != '\0' ? std::filesystem::path(home) / ".cache/fathom"
                                            : std::filesystem::path();
}

} // namespace fathom
