// SPDX-License-Identifier: Apache-2.0
#include "devices/recorded/unknown_folder.h"

#include "devices/images/depth_image.h"
#include "devices/recorded/name_words.h"
#include "engine/types/error.h"

#include <algorithm>
#include <array>
#include <string>
#include <vector>

namespace fathom {

namespace {

namespace fs = std::filesystem;

constexpr size_t kMaxBelow = 200; // folders that are looked at on each level
constexpr std::array<std::string_view, 4> kMessageFiles{".mcap", ".db3", ".bag", ".mkv"};
constexpr std::array<std::string_view, 2> kClouds{".pcd", ".ply"};

struct Entries {
    std::vector<fs::path> folders;
    fs::path file, cloud; // the first one of messages, and of a cloud, in order of names; empty = none
};

Entries entriesOf(const fs::path& folder) {
    Entries entries;
    std::error_code failed;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder, failed)) {
        const fs::path& path = entry.path();
        if (entry.is_directory(failed)) {
            if (!path.filename().string().starts_with('.') && entries.folders.size() < kMaxBelow) {
                entries.folders.push_back(path);
            }
        } else if (endsAs(path, kMessageFiles) && (entries.file.empty() || path < entries.file)) {
            entries.file = path;
        } else if (endsAs(path, kClouds) && (entries.cloud.empty() || path < entries.cloud)) {
            entries.cloud = path;
        }
    }
    std::ranges::sort(entries.folders);
    return entries;
}

// A recording one or two levels below; empty = none.
fs::path recordingBelow(const fs::path& folder, bool (*isRecording)(const fs::path&)) {
    std::vector<fs::path> level = entriesOf(folder).folders;
    for (int depth = 0; depth < 2; ++depth) {
        std::vector<fs::path> next;
        for (const fs::path& one : level) {
            std::error_code failed;
            const Entries entries = entriesOf(one);
            if (fs::exists(one / ".", failed) &&
                (isRecording(one) || fs::exists(one / "metadata.yaml", failed))) {
                return one;
            }
            if (!entries.file.empty()) {
                return entries.file;
            }
            next.insert(next.end(), entries.folders.begin(), entries.folders.end());
            next.resize(std::min(next.size(), kMaxBelow));
        }
        level = std::move(next);
    }
    return {};
}

bool namesDepth(const fs::path& path) {
    return std::ranges::any_of(nameWords(path.stem().string()), [](const std::string& word) {
        return word.find("depth") != std::string::npos;
    });
}

// Whether one of its first images holds depth.
bool holdsDepth(const fs::path& folder, bool named) {
    constexpr int kMaxTried = 5;
    std::error_code failed;
    int tried = 0;
    fs::directory_iterator at(folder, failed);
    for (; !failed && at != fs::directory_iterator() && tried < kMaxTried; at.increment(failed)) {
        const fs::path& file = at->path();
        const bool image = endsAs(file, kDepthEndings) && (named || namesDepth(file));
        tried += image ? 1 : 0;
        if (image && depthImageHeader(file).fault.empty()) {
            return true;
        }
    }
    return false;
}

template <size_t N>
bool anyAmong(const std::vector<std::string>& words, const std::array<std::string_view, N>& of) {
    return std::ranges::any_of(
        words, [&](const std::string& word) { return std::ranges::find(of, word) != of.end(); });
}

constexpr std::array<std::string_view, 6> kImageFolders{"depth", "rgb", "color", "colour", "image", "images"};
constexpr std::array<std::string_view, 4> kPoses{"pose", "poses", "trajectory", "extrinsics"};

// One of many files, as those of images.
bool isNumbered(const std::vector<std::string>& words) {
    return std::ranges::any_of(words, [](const std::string& word) {
        return word.size() >= 3 && word.find_first_not_of("0123456789") == std::string::npos;
    });
}

// The name of a file that by it may hold the lens in a form that is not read; empty = none.
std::string lensLikeIn(const fs::path& folder, bool numbered) {
    constexpr std::array<std::string_view, 8> kEndings{".json", ".txt", ".yaml", ".yml",
                                                       ".xml",  ".npy", ".csv",  ".bin"};
    constexpr std::array<std::string_view, 11> kWords{"lens",        "intrinsic",  "intrinsics", "calib",
                                                      "calibration", "camera",     "cameras",    "cam",
                                                      "camchain",    "transforms", "k"};
    std::string first;
    std::error_code failed;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder, failed)) {
        const std::string name = entry.path().filename().string();
        const std::vector<std::string> words = nameWords(entry.path().stem().string());
        const bool like = endsAs(entry.path(), kEndings) && anyAmong(words, kWords) &&
                          !anyAmong(words, kPoses) && (numbered || !isNumbered(words));
        const bool record3d = name == "metadata" && fs::is_regular_file(entry.path(), failed);
        first = (like || record3d) && (first.empty() || name < first) ? name : first;
    }
    return first;
}

// The same with its path from the folder: in it, in sparse/0/ of COLMAP, or one level below, where files of
// poses and of single images have such names, too.
std::string lensLikeFile(const fs::path& folder) {
    std::vector<fs::path> places{folder, folder / "sparse/0", folder / "colmap/sparse/0"};
    const size_t named = places.size();
    for (const fs::path& below : entriesOf(folder).folders) {
        const std::vector<std::string> words = nameWords(below.filename().string());
        if (!anyAmong(words, kPoses) && !anyAmong(words, kImageFolders)) {
            places.push_back(below);
        }
    }
    for (size_t i = 0; i < places.size(); ++i) {
        const fs::path& place = places[i];
        if (const std::string name = lensLikeIn(place, i < named); !name.empty()) {
            return (place / name).lexically_relative(folder).string();
        }
    }
    return "";
}

} // namespace

void refuseMisplacedDepth(const fs::path& folder) {
    std::error_code failed;
    if (fs::exists(folder / "depth", failed)) {
        return;
    }
    std::string place = holdsDepth(folder, false) ? "the folder itself" : "";
    for (const fs::path& below : entriesOf(folder).folders) {
        const std::string name = below.filename().string();
        place = place.empty() && holdsDepth(below, namesDepth(below)) ? name : place;
    }
    if (!place.empty()) {
        throw BadInput(
            folder.string(), "depth images", "in " + place,
            "in a folder depth, with colour images in rgb, color, image or images, and intrinsics=FILE after "
            "the folder name: lens and depth scale as docs/guide/recordings.md has them");
    }
}

void refuseUnknownFolder(const fs::path& folder, bool (*isRecording)(const fs::path&)) {
    if (const fs::path file = entriesOf(folder).file; !file.empty()) {
        throw BadInput(folder.string(), "metadata.yaml", "missing",
                       "metadata.yaml of a ROS 2 recording, or the name of one file: " + file.string());
    }
    if (const fs::path below = recordingBelow(folder, isRecording); !below.empty()) {
        throw BadInput(folder.string(), "folder", "no recording itself",
                       "one inside of it: " + below.string());
    }
    if (const fs::path cloud = entriesOf(folder).cloud; !cloud.empty()) {
        throw BadInput(folder.string(), "folder", "a folder of point clouds",
                       "one cloud, " + cloud.string() + "; or clouds in a bag");
    }
    refuseMisplacedDepth(folder);
    const std::string lens = lensLikeFile(folder);
    throw BadInput(
        (folder / "intrinsics.json").string(), "file",
        lens.empty() ? "missing" : "missing; " + lens + " is there, which is not read by itself",
        "intrinsics.json (docs/guide/recordings.md has every field), or intrinsics=FILE after the "
        "folder name (its images pair by an index, or by number in depth/ and rgb/, color/, image/ or "
        "images/), or a "
        "folder of Open3D (camera_intrinsic.json), BOP (scene_camera.json), 7-Scenes or BundleFusion "
        "(frame-000000.depth.png), ScanNet (intrinsic/ or intrinsics_depth.txt) or, without an "
        "index, FoundationPose (cam_K.txt)");
}

} // namespace fathom
