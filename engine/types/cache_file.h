// SPDX-License-Identifier: Apache-2.0
// Files of the cache folder, which several processes read and replace, and the hash of their contents.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string_view>

namespace fathom {

// Replaces the file atomically and makes its folder. Any thread and process. If it throws Error, which names
// the file, the file is unchanged and no temporary file remains.
void storeCacheFile(const std::filesystem::path& file, std::string_view bytes);

// FNV-1a, 64 bits: detects truncated or damaged files, not manipulation. start: the hash of the bytes before,
// or another number for an independent hash.
inline constexpr uint64_t kFnvStart = 0xcbf29ce484222325u;
constexpr uint64_t fnv1a(std::string_view bytes, uint64_t start = kFnvStart) noexcept {
    uint64_t hash = start;
    for (const char c : bytes) {
        hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3u;
    }
    return hash;
}

} // namespace fathom
