// SPDX-License-Identifier: Apache-2.0
#include "engine/types/cache_file.h"

#include "engine/types/error.h"

#include <atomic>
#include <fstream>
#include <string>
#include <system_error>
#include <unistd.h>

namespace fathom {

namespace {

// A temporary name in the same folder, unique to this process and call.
std::filesystem::path freshBeside(const std::filesystem::path& file) {
    static std::atomic<uint32_t> count{0};
    return file.string() + "." + std::to_string(::getpid()) + "." + std::to_string(count++) + ".new";
}

} // namespace

void storeCacheFile(const std::filesystem::path& file, std::string_view bytes) {
    const std::filesystem::path fresh = freshBeside(file);
    std::error_code failed;
    std::filesystem::create_directories(file.parent_path(), failed);
    std::ofstream out(fresh, std::ios::binary);
    out.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    out.close(); // writes the remaining bytes; may fail on a full disk
    if (out) {
        std::filesystem::rename(fresh, file, failed);
    }
    if (!out || failed) {
        const std::string why = out ? failed.message() : "cannot be written whole";
        std::filesystem::remove(fresh, failed);
        throw Error(file.string() + ": " + why);
    }
}

} // namespace fathom
