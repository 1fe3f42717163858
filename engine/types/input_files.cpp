// SPDX-License-Identifier: Apache-2.0
#include "engine/types/input_files.h"

#include "engine/types/error.h"

#include <mutex>
#include <optional>
#include <set>
#include <sys/stat.h>
#include <tuple>

namespace fathom {

namespace {

// With the time of the last change, because a deleted file's inode is used again.
using Identity = std::tuple<dev_t, ino_t, time_t, long>;
constexpr size_t kMax = 100'000; // bounds the memory of a long run

std::mutex mutex; // of inputs
std::set<Identity> inputs;

std::optional<Identity> identityOf(const std::filesystem::path& file) {
    struct stat status {};
    return ::stat(file.c_str(), &status) == 0
               ? std::optional<Identity>(
                     {status.st_dev, status.st_ino, status.st_mtim.tv_sec, status.st_mtim.tv_nsec})
               : std::nullopt;
}

} // namespace

void noteInput(const std::filesystem::path& file) {
    if (const auto identity = identityOf(file)) {
        const std::lock_guard lock(mutex);
        if (inputs.size() < kMax) {
            inputs.insert(*identity);
        }
    }
}

bool isInput(const std::filesystem::path& file) {
    const auto identity = identityOf(file);
    const std::lock_guard lock(mutex);
    return identity && inputs.count(*identity) != 0;
}

void refuseInput(const std::filesystem::path& file) {
    if (isInput(file)) {
        throw BadInput(file.string(), "output", "the input itself", "a file that the program does not read");
    }
}

} // namespace fathom
