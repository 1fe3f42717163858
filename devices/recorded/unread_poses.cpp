// SPDX-License-Identifier: Apache-2.0
#include "devices/recorded/unread_poses.h"

#include "devices/recorded/name_words.h"
#include "devices/recorded/pose_json.h"
#include "devices/recorded/pose_text.h"
#include "engine/types/read_file.h"

#include <algorithm>
#include <array>
#include <cstdint>
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
    constexpr std::array<std::string_view, 11> kWords{"pose",       "poses",        "extrinsic", "extrinsics",
                                                      "trajectory", "trajectories", "cameras",   "odom",
                                                      "cam2world",  "c2w",          "w2c"};
    return std::ranges::any_of(words, [&](const std::string& word) { return isAmong(word, kWords); });
}

// Gaussian splatting and COLMAP; NeuS and IDR, but not "camera.npz" and the like, which are lenses.
bool isKnownFile(const fs::path& file) {
    constexpr std::array<std::string_view, 6> kNames{"cameras.json",      "images.bin",
                                                     "cameras.npz",       "cameras_sphere.npz",
                                                     "cameras_large.npz", "cameras_linear_init.npz"};
    std::error_code failed;
    const std::string name = file.filename().string();
    return isAmong(name, kNames) ||
           (name == "images.txt" && fs::exists(file.parent_path() / "cameras.txt", failed));
}

// FoundationPose and YCBInEOAT keep the poses of an object under the second name.
bool nameOtherPoses(const std::vector<std::string>& words) {
    return nameOtherThing(words) || words == std::vector<std::string>{"annotated", "poses"};
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
    if (nameOtherPoses(words)) {
        return false;
    }
    if (fs::is_directory(file, failed)) {
        return isPoseFolder(words) || holdsPoseWord(plain);
    }
    const std::string ending = endingOf(file);
    constexpr std::array<std::string_view, 4> kWords{"pose", "odom", "c2w", "w2c"};
    const bool word =
        std::ranges::any_of(words, [&](const std::string& one) { return isAmong(one, kWords); });
    return isKnownFile(file) || ending == ".pose" ||
           (isAmong(ending, kEndings) && (word || ending == ".traj" || holdsPoseWord(plain)));
}

// Also of readings of an IMU: "imu0", "gyroscope"; and of cameras to each other: "calibration".
bool nameOtherReadings(const std::vector<std::string>& words) {
    constexpr std::array<std::string_view, 4> kOthers{"imu", "gyro", "accel", "calib"};
    return nameOtherPoses(words) || std::ranges::any_of(words, [&](const std::string& word) {
               return std::ranges::any_of(kOthers,
                                          [&](std::string_view start) { return word.starts_with(start); });
           });
}

// A text whose lines or keys are poses, under any name but those of other readings. Record3D's metadata has
// no ending. texts: counts those read. fewest: motions of JSON under a key of any name.
bool isPoseText(const fs::path& file, size_t& texts, size_t fewest) {
    constexpr std::array<std::string_view, 8> kEndings{".txt",      ".log",  ".csv", ".tum",
                                                       ".freiburg", ".traj", ".gt",  ".sim"};
    const bool json = endingOf(file) == ".json" || file.filename() == "metadata";
    if (nameOtherReadings(nameWords(file.stem().string())) || !(json || isAmong(endingOf(file), kEndings)) ||
        !isRegularFile(file)) {
        return false;
    }
    ++texts;
    return json ? holdsJsonPoses(file, fewest) : holdsPoses(file);
}

// What is looked at in one folder: it may hold one text for each image.
struct Budget {
    size_t texts, entries;
    size_t fewest; // as above
};

// The name of the file or folder in this one that holds poses; empty = none.
std::string posesIn(const fs::path& folder, Budget most) {
    std::string found;
    size_t texts = 0, entries = 0;
    std::error_code failed;
    fs::directory_iterator at(folder, failed);
    for (; !failed && at != fs::directory_iterator() && entries < most.entries; at.increment(failed)) {
        const std::string name = at->path().filename().string();
        const auto order = [](const std::string& one) {
            return std::tuple(one != kOwnPoses, one != kTumPoses, one);
        };
        const bool poses =
            namesPoses(at->path()) || (texts < most.texts && isPoseText(at->path(), texts, most.fewest));
        if (poses && (found.empty() || order(name) < order(found))) {
            found = name;
        }
        ++entries;
    }
    return found;
}

// Folders in which the poses of a recording may lie: scene/ of Open3D, sparse/0/ of COLMAP and of gaussian
// splatting, and others one level below. Not those of recordings of their own.
std::vector<fs::path> foldersBelow(const fs::path& folder) {
    constexpr size_t kMaxFolders = 50;
    std::vector<fs::path> below;
    std::error_code failed;
    fs::directory_iterator at(folder, failed);
    for (; !failed && at != fs::directory_iterator() && below.size() < kMaxFolders; at.increment(failed)) {
        const fs::path name = at->path().filename();
        std::error_code none;
        if (at->is_directory(none) && !name.string().starts_with('.') &&
            !nameOtherReadings(nameWords(name.string())) &&
            !fs::exists(at->path() / "intrinsics.json", none)) {
            below.push_back(name);
        }
    }
    std::ranges::sort(below);
    for (const char* deep : {"sparse/0", "colmap/sparse/0"}) {
        below.emplace_back(deep);
    }
    return below;
}

// Its path from the folder of the recording; empty = none.
std::string findPoses(const fs::path& folder, size_t images) {
    const size_t fewest = std::max(size_t{3}, images / 2); // others are of a few cameras or things
    const Budget here{.texts = 50, .entries = SIZE_MAX, .fewest = fewest},
        inBelow{.texts = 10, .entries = 200, .fewest = fewest};
    std::string found = posesIn(folder, here);
    const std::vector<fs::path> below = found.empty() ? foldersBelow(folder) : std::vector<fs::path>{};
    for (auto at = below.begin(); at != below.end() && found.empty(); ++at) {
        const std::string name = posesIn(folder / *at, inBelow);
        found = name.empty() ? "" : (*at / name).string();
    }
    return found;
}

} // namespace

std::string unreadPoses(const fs::path& folder, size_t images) {
    const std::string found = findPoses(folder, images);
    if (found.empty()) {
        return "";
    }
    return "the camera counts as fixed: " + found + " is not read (" +
           (found == kOwnPoses
                ? "it is read by the stamps of an index: intrinsics.json and associations.txt, or depth.txt "
                  "and rgb.txt"
            : found == kTumPoses
                ? "copy it to poses.txt for a moving camera"
                : "a moving camera needs poses.txt next to intrinsics.json: t x y z qx qy qz qw") +
           ")";
}

} // namespace fathom
