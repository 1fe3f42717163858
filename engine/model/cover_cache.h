// SPDX-License-Identifier: Apache-2.0
// Covers of meshes from earlier runs, found by the content of the mesh file and the options.
#pragma once

#include "engine/model/link_spheres.h"

#include <filesystem>
#include <optional>
#include <string>

namespace fathom {

// Files in one folder, at most kMaxFiles; the oldest are removed. Each has a checksum, and one that is
// damaged counts as missing. Any thread and process; every failure means only that nothing is cached.
class CoverCache {
public:
    static constexpr size_t kMaxFiles = 2048;

    // $XDG_CACHE_HOME/fathom/covers or ~/.cache/fathom/covers; without both nothing is cached.
    CoverCache();
    explicit CoverCache(std::filesystem::path folder)
        : folder_(std::move(folder)) {}

    // Key of a mesh file's content with options in words; empty = nothing is cached, as for a file that
    // cannot be read.
    std::string keyOf(const std::filesystem::path& mesh, const std::string& options) const;
    std::optional<ShapeSpheres> find(const std::string& key) const;
    bool store(const std::string& key, const ShapeSpheres& made) const; // true: the next find() has it
    const std::filesystem::path& folder() const { return folder_; }

private:
    void trim() const;

    std::filesystem::path folder_;
};

} // namespace fathom
