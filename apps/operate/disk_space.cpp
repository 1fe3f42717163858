// SPDX-License-Identifier: Apache-2.0
#include "apps/operate/disk_space.h"

#include "engine/types/printed.h"

#include <algorithm>

namespace fathom::operate {

std::optional<uint64_t> freeSpace(const std::filesystem::path& folder) {
    std::error_code failed;
    std::filesystem::path there = std::filesystem::absolute(folder, failed);
    while (!failed && there.has_relative_path() && !std::filesystem::exists(there, failed)) {
        there = there.parent_path();
    }
    const std::filesystem::space_info space = std::filesystem::space(there, failed);
    return failed ? std::nullopt : std::optional<uint64_t>(space.available);
}

void DiskSpace::look(const std::filesystem::path& folder, double now) {
    constexpr double kPeriod = 0.5; // [s]
    if (!measured_ || now - *measured_ >= kPeriod) {
        measured_ = now;
        left_ = measure_(folder);
    }
}

std::string DiskSpace::problem() const {
    return left_ && *left_ < kMinFree ? "only " + byteText(*left_) + " of the disk left" : "";
}

std::string byteText(uint64_t bytes) {
    constexpr const char* kUnits[] = {"kB", "MB", "GB", "TB"};
    double size = static_cast<double>(bytes) / 1e3;
    size_t unit = 0;
    for (; size >= 999.5 && unit + 1 < std::size(kUnits); ++unit) {
        size /= 1e3;
    }
    return printed(size < 9.95 ? "%.1f " : "%.0f ", size) + kUnits[unit];
}

std::string clockText(double seconds) {
    const auto all = static_cast<unsigned>(std::max(0.0, seconds));
    const unsigned hours = all / 3600, minutes = all / 60 % 60;
    return (hours > 0 ? printed("%u:%02u", hours, minutes) : printed("%u", minutes)) +
           printed(":%02u", all % 60);
}

} // namespace fathom::operate
