// SPDX-License-Identifier: Apache-2.0
#include "devices/recorded/unread_poses.h"

#include "engine/types/read_file.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <string_view>
#include <tuple>

namespace fathom {

namespace {

namespace fs = std::filesystem;

constexpr const char *kOwnPoses = "poses.txt",
                     *kTumPoses = "groundtruth.txt"; // in the same format

// Files of one pose per object or per joint have other names.
bool namesPoses(const fs::path& file) {
    constexpr std::array<std::string_view, 7> kWords{"groundtruth", "ground_truth", "trajectory", "traj",
                                                     "transforms",  "poses",        "odometry"};
    constexpr std::array<std::string_view, 6> kEndings{".txt", ".log", ".json", ".csv", ".tum", ".freiburg"};
    std::string stem = file.stem().string();
    std::ranges::transform(stem, stem.begin(), [](unsigned char c) { return std::tolower(c); });
    std::error_code failed;
    if (fs::is_directory(file, failed)) {
        return stem == "pose" || stem == "poses";
    }
    const std::string ending = endingOf(file);
    return std::ranges::find(kEndings, ending) != kEndings.end() &&
           std::ranges::any_of(kWords,
                               [&](std::string_view word) { return stem.find(word) != std::string::npos; });
}

} // namespace

std::string unreadPoses(const fs::path& folder) {
    std::string found;
    std::error_code failed;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder, failed)) {
        const std::string name = entry.path().filename().string();
        const auto order = [](const std::string& one) {
            return std::tuple(one != kOwnPoses, one != kTumPoses, one);
        };
        if (namesPoses(entry.path()) && (found.empty() || order(name) < order(found))) {
            found = name;
        }
    }
    if (found.empty()) {
        return "";
    }
    return "the camera counts as fixed: " + found + " is not read (" +
           (found == kOwnPoses
                ? "it is read by the stamps of an index: intrinsics.json and associations.txt, or depth.txt "
                  "and rgb.txt"
            : found == kTumPoses
                ? "copy it to poses.txt for a moving camera"
                : "a moving camera needs poses.txt beside intrinsics.json: t x y z qx qy qz qw") +
           ")";
}

} // namespace fathom
