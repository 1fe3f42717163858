// SPDX-License-Identifier: Apache-2.0
#include "devices/recorded/unread_poses.h"

#include "devices/recorded/name_words.h"
#include "devices/recorded/pose_text.h"
#include "engine/types/read_file.h"

#include <algorithm>
#include <array>
#include <string_view>
#include <tuple>
#include <vector>

namespace fathom {

namespace {

namespace fs = std::filesystem;

constexpr const char *kOwnPoses = "poses.txt",
                     *kTumPoses = "groundtruth.txt"; // in the same format

template <size_t N>
bool isAmong(std::string_view word, const std::array<std::string_view, N>& words) {
    return std::ranges::find(words, word) != words.end();
}

// Words of poses in one: "groundtruth3", "cam2world".
bool holdsPoseWord(const std::string& plain) {
    constexpr std::array<std::string_view, 8> kParts{
        "groundtruth", "traj", "transforms", "poses", "odometry", "cam2world", "camtoworld", "cameratoworld"};
    return std::ranges::any_of(kParts,
                               [&](std::string_view part) { return plain.find(part) != std::string::npos; });
}

bool isPoseFolder(const std::vector<std::string>& words) {
    constexpr std::array<std::string_view, 10> kWords{"pose",       "poses",        "extrinsic", "extrinsics",
                                                      "trajectory", "trajectories", "cameras",   "odom",
                                                      "cam2world",  "c2w"};
    return std::ranges::any_of(words, [&](const std::string& word) { return isAmong(word, kWords); });
}

// Gaussian splatting and COLMAP.
bool isKnownFile(const fs::path& file) {
    std::error_code failed;
    const std::string name = file.filename().string();
    return name == "cameras.json" || name == "images.bin" ||
           (name == "images.txt" && fs::exists(file.parent_path() / "cameras.txt", failed));
}

// Files of one pose per object or per joint have other names.
bool namesPoses(const fs::path& file) {
    constexpr std::array<std::string_view, 14> kEndings{".txt",      ".log",  ".json", ".csv", ".tum",
                                                        ".freiburg", ".traj", ".yaml", ".yml", ".npy",
                                                        ".npz",      ".mat",  ".xml",  ".pkl"};
    const std::vector<std::string> words = nameWords(file.stem().string());
    std::string plain;
    std::ranges::for_each(words, [&](const std::string& word) { plain += word; });
    std::error_code failed;
    if (nameOtherThing(words)) {
        return false;
    }
    if (fs::is_directory(file, failed)) {
        return isPoseFolder(words) || holdsPoseWord(plain);
    }
    const std::string ending = endingOf(file);
    const bool word =
        std::ranges::any_of(words, [](const std::string& one) { return one == "pose" || one == "odom"; });
    return isKnownFile(file) ||
           (isAmong(ending, kEndings) && (word || ending == ".traj" || holdsPoseWord(plain)));
}

// A text whose lines are poses, under any name but those of other readings. texts: counts those read.
bool isPoseText(const fs::path& file, size_t& texts) {
    constexpr std::array<std::string_view, 8> kEndings{".txt",      ".log",  ".csv", ".tum",
                                                       ".freiburg", ".traj", ".gt",  ".sim"};
    constexpr std::array<std::string_view, 3> kOthers{"imu", "gyro", "accel"}; // also "imu0", "gyroscope"
    const std::vector<std::string> words = nameWords(file.stem().string());
    const bool other = nameOtherThing(words) || std::ranges::any_of(words, [&](const std::string& word) {
                           return std::ranges::any_of(
                               kOthers, [&](std::string_view start) { return word.starts_with(start); });
                       });
    if (other || !isAmong(endingOf(file), kEndings) || !isRegularFile(file)) {
        return false;
    }
    ++texts;
    return holdsPoses(file);
}

} // namespace

std::string unreadPoses(const fs::path& folder) {
    constexpr size_t kMaxTexts = 50; // that are read: a folder may hold one of each image
    std::string found;
    size_t texts = 0;
    std::error_code failed;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder, failed)) {
        const std::string name = entry.path().filename().string();
        const auto order = [](const std::string& one) {
            return std::tuple(one != kOwnPoses, one != kTumPoses, one);
        };
        const bool poses = namesPoses(entry.path()) || (texts < kMaxTexts && isPoseText(entry.path(), texts));
        if (poses && (found.empty() || order(name) < order(found))) {
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
