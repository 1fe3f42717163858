// SPDX-License-Identifier: Apache-2.0
#include "devices/recorded/recording_layout.h"

#include "devices/images/depth_image.h"
#include "devices/recorded/colour_image.h"
#include "devices/recorded/json_field.h"
#include "devices/recorded/text_file.h"
#include "engine/types/error.h"
#include "engine/types/log.h"

#include <algorithm>
#include <cmath>
#include <glm/mat3x3.hpp>
#include <map>

namespace fathom {

namespace {

namespace fs = std::filesystem;

constexpr double kPeriod = 1.0 / 30.0; // [s] of layouts without stamps
constexpr std::array<double, 16> kIdentity{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};

// Files of these endings by the number that ends their name's stem, in front of `before`.
std::map<uint32_t, fs::path> numbered(const fs::path& folder, std::span<const std::string_view> endings,
                                      const std::string& before = "") {
    std::map<uint32_t, fs::path> files;
    std::error_code failed;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder, failed)) {
        std::string stem = entry.path().stem().string();
        if (!endsAs(entry.path(), endings) || !stem.ends_with(before)) {
            continue;
        }
        stem.resize(stem.size() - before.size());
        const size_t digit = stem.find_last_not_of("0123456789") + 1;
        uint32_t number = 0;
        if (digit < stem.size() && parseNumber(std::string_view(stem).substr(digit), number)) {
            files.emplace(number, entry.path());
        }
    }
    return files;
}

// Depth images with their colour images of the same number.
std::vector<IndexLine> pairsOf(const std::map<uint32_t, fs::path>& depth,
                               const std::map<uint32_t, fs::path>& colour, const fs::path& folder) {
    std::vector<IndexLine> index;
    for (const auto& [number, file] : depth) {
        const double stamp = kPeriod * static_cast<double>(index.size());
        const auto pair = colour.find(number);
        index.push_back(
            {stamp, stamp, file, pair == colour.end() ? fs::path() : pair->second,
             pair == colour.end() ? "no colour image with the number " + std::to_string(number) : "",
             std::nullopt});
    }
    if (index.empty()) {
        throw BadInput(folder.string(), "depth images", "none", "at least one, with a number in its name");
    }
    return index;
}

Pose poseOf(const std::array<double, 9>& rows, const dvec3& position, const std::string& file) {
    const glm::dmat3 rotation(rows[0], rows[3], rows[6], rows[1], rows[4], rows[7], rows[2], rows[5],
                              rows[8]);
    const dquat q = glm::quat_cast(rotation);
    const double length = glm::length(q);
    if (!(std::abs(length - 1.0) < 0.1) || !std::isfinite(position.x + position.y + position.z)) {
        throw BadInput(file, "pose", "not a rigid motion", "a rotation matrix and a position");
    }
    return {position, q / length};
}

RecordingLayout readOpen3d(const fs::path& folder) {
    RecordingLayout layout;
    layout.intrinsics = readIntrinsics(folder / "camera_intrinsic.json", ScaleRule::Optional);
    const bool american = fs::exists(folder / "color");
    layout.index = pairsOf(numbered(folder / "depth", kDepthEndings),
                           numbered(folder / (american ? "color" : "rgb"), kColourEndings), folder);
    return layout;
}

struct BopImage {
    std::array<double, 9> k{}; // row by row
    double unit = 0.0;         // [mm]
    std::optional<Pose> baseTcamera;
};

std::map<uint32_t, BopImage> bopImages(const fs::path& file) {
    const nlohmann::json document = parseJsonFile(file);
    const JsonField root(document, file.string(), "");
    std::map<uint32_t, BopImage> images;
    for (const auto& [key, unused] : document.items()) {
        uint32_t number = 0;
        if (!parseNumber(std::string_view(key), number)) {
            throw BadInput(file.string(), key, "not a number", "numbers of images");
        }
        const JsonField entry = root.at(key);
        BopImage image;
        const std::vector<double> k = entry.at("cam_K").numbers(9);
        std::copy(k.begin(), k.end(), image.k.begin());
        image.unit = entry.at("depth_scale").positive();
        const auto rotation = entry.find("cam_R_w2c"), position = entry.find("cam_t_w2c");
        if (rotation && position) {
            const std::vector<double> r = rotation->numbers(9), t = position->numbers(3);
            std::array<double, 9> rows{};
            std::copy(r.begin(), r.end(), rows.begin());
            image.baseTcamera =
                inverse(poseOf(rows, dvec3(t[0], t[1], t[2]) * 1e-3, file.string())); // world to camera [mm]
        }
        images.emplace(number, image);
    }
    return images;
}

RecordingLayout readBop(const fs::path& folder) {
    const fs::path file = folder / "scene_camera.json";
    const std::map<uint32_t, BopImage> images = bopImages(file);
    const auto depth = numbered(folder / "depth", kDepthEndings);
    RecordingLayout layout;
    layout.index = pairsOf(depth, numbered(folder / "rgb", kColourEndings), folder);
    size_t line = 0;
    std::optional<BopImage> first;
    for (const auto& [number, path] : depth) {
        IndexLine& entry = layout.index[line++];
        const auto image = images.find(number);
        if (image == images.end()) {
            entry.fault = "scene_camera.json has no image " + std::to_string(number);
            continue;
        }
        first = first ? first : std::optional(image->second);
        if (image->second.k != first->k || image->second.unit != first->unit) {
            entry.fault = "lens or depth_scale differs from the first image";
        }
        entry.baseTcamera = image->second.baseTcamera;
    }
    const PngSize size = depthImageHead(layout.index.front().depth).size;
    const double unit = first ? 1e-3 * first->unit : 0.0;
    if (!first || size.width < 1 || size.width > kMaxImageWidth || size.height > kMaxImageHeight ||
        !(first->k[0] > 0.0 && first->k[4] > 0.0) || unit < kFinestUnit || unit > kCoarsestUnit) {
        throw BadInput(file.string(), "cam_K, depth_scale", "unusable",
                       "a lens and millimetres per unit (0.001 to 100) for the first depth image");
    }
    CameraInfo& camera = layout.intrinsics.camera;
    camera.depth.width = size.width;
    camera.depth.height = size.height;
    camera.depth.fx = first->k[0];
    camera.depth.fy = first->k[4];
    camera.depth.cx = first->k[2];
    camera.depth.cy = first->k[5];
    camera.colour = camera.depth;
    layout.intrinsics.scale = camera.metresPerUnit = unit;
    return layout;
}

// A matrix of 4 rows, or of 3 where a lens may have so many, as 4 x 4, row by row.
std::array<double, 16> readMatrix(const fs::path& file, bool orThree = false) {
    std::vector<double> all;
    for (const TextLine& line : readDataLines(file)) {
        for (const std::string_view word : splitWords(line.text)) {
            double value = 0.0;
            if (!parseNumber(word, value)) {
                throw BadInput(file.string(), "matrix", std::string(word), "numbers");
            }
            all.push_back(value);
        }
    }
    if (all.size() != 16 && !(orThree && all.size() == 9)) {
        throw BadInput(file.string(), "matrix", std::to_string(all.size()) + " numbers",
                       orThree ? "4 x 4 or 3 x 3" : "4 x 4");
    }
    const size_t rows = all.size() == 16 ? 4 : 3;
    auto out = kIdentity;
    for (size_t k = 0; k < all.size(); ++k) {
        out[k / rows * 4 + k % rows] = all[k];
    }
    return out;
}

// The camera's pose in a frame; a frame whose pose was lost (-inf) is not played.
void usePose(IndexLine& line, const fs::path& file) {
    if (!fs::exists(file)) {
        return;
    }
    try {
        const auto m = readMatrix(file);
        line.baseTcamera = poseOf({m[0], m[1], m[2], m[4], m[5], m[6], m[8], m[9], m[10]},
                                  {m[3], m[7], m[11]}, file.string());
    } catch (const BadInput& e) {
        line.fault = e.what();
    }
}

Intrinsics scanNetLens(const fs::path& file, std::optional<PngSize> size) {
    const auto k = readMatrix(file, true);
    if (!size || size->width > kMaxImageWidth || size->height > kMaxImageHeight ||
        !(k[0] > 0.0 && k[5] > 0.0) || !std::isfinite(k[0] + k[2] + k[5] + k[6])) {
        throw BadInput(file.string(), "matrix", "unusable",
                       "fx 0 cx, 0 fy cy, 0 0 1 of images that are read");
    }
    return {.width = size->width, .height = size->height, .fx = k[0], .fy = k[5], .cx = k[2], .cy = k[6]};
}

RecordingLayout readScanNet(const fs::path& folder) {
    for (const char* name : {"extrinsic_depth.txt", "extrinsic_color.txt"}) {
        if (fs::exists(folder / "intrinsic" / name) && readMatrix(folder / "intrinsic" / name) != kIdentity) {
            throw BadInput((folder / "intrinsic" / name).string(), "matrix", "not the identity",
                           "the identity; or intrinsics=FILE behind the folder's name");
        }
    }
    RecordingLayout layout;
    layout.index = pairsOf(numbered(folder / "depth", kDepthEndings),
                           numbered(folder / "color", kColourEndings), folder);
    CameraInfo& camera = layout.intrinsics.camera;
    camera.depth = scanNetLens(folder / "intrinsic" / "intrinsic_depth.txt",
                               depthImageHead(layout.index.front().depth).size);
    camera.colour = scanNetLens(folder / "intrinsic" / "intrinsic_color.txt",
                                colourImageSize(layout.index.front().colour));
    camera.registered = false; // two lenses at one place
    for (IndexLine& line : layout.index) {
        usePose(line, folder / "pose" / (line.depth.stem().string() + ".txt"));
    }
    return layout;
}

RecordingLayout readSevenScenes(const fs::path& folder) {
    RecordingLayout layout;
    CameraInfo& camera = layout.intrinsics.camera;
    // The data set's own calibration.
    camera.depth =
        Intrinsics{.width = 640, .height = 480, .fx = 585.0, .fy = 585.0, .cx = 320.0, .cy = 240.0};
    camera.colour = camera.depth;
    layout.invalid = 65535;
    constexpr std::array<std::string_view, 1> kPng{".png"};
    layout.index =
        pairsOf(numbered(folder, kPng, ".depth"), numbered(folder, kColourEndings, ".color"), folder);
    for (IndexLine& line : layout.index) {
        std::string pose = line.depth.string();
        pose.replace(pose.size() - std::string_view("depth.png").size(), std::string::npos, "pose.txt");
        usePose(line, pose);
    }
    return layout;
}

// By the first depth image that can be read. Depth scales are for integers.
bool holdsMetres(const RecordingLayout& layout) {
    for (const IndexLine& line : layout.index) {
        const DepthHead head = depthImageHead(line.depth);
        if (line.fault.empty() && head.fault.empty()) {
            return head.metres;
        }
    }
    return false;
}

RecordingLayout readTum(const fs::path& folder, const fs::path& intrinsics) {
    RecordingLayout layout;
    layout.intrinsics = readIntrinsics(intrinsics, ScaleRule::Unchecked);
    layout.index = readIndex(folder, layout.intrinsics);
    if (!holdsMetres(layout)) {
        layout.intrinsics = readIntrinsics(intrinsics);
    }
    if (fs::exists(folder / "poses.txt")) {
        layout.poses.emplace(folder / "poses.txt");
    }
    return layout;
}

RecordingLayout readFolder(const fs::path& folder, const SourceOptions& options) {
    if (!options.intrinsics.empty() || fs::exists(folder / "intrinsics.json")) {
        return readTum(folder, options.intrinsics.empty() ? folder / "intrinsics.json" : options.intrinsics);
    }
    if (fs::exists(folder / "camera_intrinsic.json")) {
        return readOpen3d(folder);
    }
    if (fs::exists(folder / "scene_camera.json")) {
        return readBop(folder);
    }
    if (fs::exists(folder / "frame-000000.depth.png")) {
        return readSevenScenes(folder);
    }
    if (fs::exists(folder / "intrinsic" / "intrinsic_depth.txt")) {
        return readScanNet(folder);
    }
    throw BadInput((folder / "intrinsics.json").string(), "file", "missing",
                   "intrinsics.json (docs/guide/recordings.md has every field), or intrinsics=FILE behind "
                   "the folder's name, or a folder of Open3D, BOP, 7-Scenes or ScanNet");
}

} // namespace

RecordingLayout readLayout(const fs::path& folder, const SourceOptions& options) {
    RecordingLayout layout = readFolder(folder, options);
    layout.metres = holdsMetres(layout);
    layout.statedUnit = layout.intrinsics.scale;
    return layout;
}

} // namespace fathom
