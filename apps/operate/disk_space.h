// SPDX-License-Identifier: Apache-2.0
// How much of the disk a recording may still take.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>

namespace fathom::operate {

// A recording ends before less than this is free [bytes], so that other programs can still write.
inline constexpr uint64_t kMinFree = 100'000'000;

// Free space [bytes] on the disk of a folder that need not exist yet; empty when it is unknown.
std::optional<uint64_t> freeSpace(const std::filesystem::path& folder);

// Measures at most twice a second.
class DiskSpace {
public:
    explicit DiskSpace(
        std::function<std::optional<uint64_t>(const std::filesystem::path&)> measure = freeSpace)
        : measure_(std::move(measure)) {}

    // now [s]: of any clock.
    void look(const std::filesystem::path& folder, double now);
    std::optional<uint64_t> left() const { return left_; } // [bytes] as measured last
    std::string problem() const; // why a recording must end; empty = it may continue

private:
    std::function<std::optional<uint64_t>(const std::filesystem::path&)> measure_;
    std::optional<uint64_t> left_;
    std::optional<double> measured_; // [s]
};

std::string byteText(uint64_t bytes);  // "3.4 MB", "120 GB"
std::string clockText(double seconds); // "0:07", "1:02:03"

} // namespace fathom::operate
