// SPDX-License-Identifier: Apache-2.0
#include "devices/recorded/recording_layout.h"

#include "devices/images/depth_image.h"
#include "devices/recorded/bop_folder.h"
#include "devices/recorded/colour_image.h"
#include "devices/recorded/matrix_file.h"
#include "devices/recorded/numbered_images.h"
#include "engine/types/error.h"

#include <algorithm>
#include <cmath>

namespace fathom {

namespace {

namespace fs = std::filesystem;

RecordingLayout readOpen3d(const fs::path& folder, bool depthOnly) {
    RecordingLayout layout;
    layout.intrinsics = readIntrinsics(folder / "camera_intrinsic.json", ScaleRule::Optional);
    const bool american = fs::exists(folder / "color");
    layout.index = pairByNumber({folder / "depth", kDepthEndings},
                                {folder / (american ? "color" : "rgb"), kColourEndings}, depthOnly);
    return layout;
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

std::optional<PngSize> firstColourSize(const std::vector<IndexLine>& index) {
    const auto first =
        std::ranges::find_if(index, [](const IndexLine& line) { return !line.colour.empty(); });
    return first == index.end() ? std::nullopt : colourImageSize(first->colour);
}

RecordingLayout readScanNet(const fs::path& folder, bool depthOnly) {
    for (const char* name : {"extrinsic_depth.txt", "extrinsic_color.txt"}) {
        if (fs::exists(folder / "intrinsic" / name) &&
            readMatrix(folder / "intrinsic" / name) != kIdentityMatrix) {
            throw BadInput((folder / "intrinsic" / name).string(), "matrix", "not the identity",
                           "the identity; or intrinsics=FILE behind the folder's name");
        }
    }
    RecordingLayout layout;
    layout.index =
        pairByNumber({folder / "depth", kDepthEndings}, {folder / "color", kColourEndings}, depthOnly);
    CameraInfo& camera = layout.intrinsics.camera;
    camera.depth = scanNetLens(folder / "intrinsic" / "intrinsic_depth.txt",
                               depthImageHead(layout.index.front().depth).size);
    camera.colour = camera.depth;
    if (!depthOnly) {
        camera.colour =
            scanNetLens(folder / "intrinsic" / "intrinsic_color.txt", firstColourSize(layout.index));
        camera.registered = false; // two lenses at one place
    }
    for (IndexLine& line : layout.index) {
        layout.posePerImage |= usePose(line, folder / "pose" / (line.depth.stem().string() + ".txt"));
    }
    return layout;
}

RecordingLayout readSevenScenes(const fs::path& folder, bool depthOnly) {
    RecordingLayout layout;
    CameraInfo& camera = layout.intrinsics.camera;
    // The data set's own calibration.
    camera.depth =
        Intrinsics{.width = 640, .height = 480, .fx = 585.0, .fy = 585.0, .cx = 320.0, .cy = 240.0};
    camera.colour = camera.depth;
    layout.invalid = 65535;
    constexpr std::array<std::string_view, 1> kPng{".png"};
    layout.index = pairByNumber({folder, kPng, ".depth"}, {folder, kColourEndings, ".color"}, depthOnly);
    for (IndexLine& line : layout.index) {
        std::string pose = line.depth.string();
        pose.replace(pose.size() - std::string_view("depth.png").size(), std::string::npos, "pose.txt");
        layout.posePerImage |= usePose(line, pose);
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

RecordingLayout readTum(const fs::path& folder, const fs::path& intrinsics, bool depthOnly) {
    RecordingLayout layout;
    layout.intrinsics = readIntrinsics(intrinsics, ScaleRule::Unchecked);
    layout.index = readIndex(folder, layout.intrinsics, depthOnly);
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
        return readTum(folder, options.intrinsics.empty() ? folder / "intrinsics.json" : options.intrinsics,
                       options.depthOnly());
    }
    if (fs::exists(folder / "camera_intrinsic.json")) {
        return readOpen3d(folder, options.depthOnly());
    }
    if (fs::exists(folder / "scene_camera.json")) {
        return readBop(folder, options.depthOnly());
    }
    if (fs::exists(folder / "frame-000000.depth.png")) {
        return readSevenScenes(folder, options.depthOnly());
    }
    if (fs::exists(folder / "intrinsic" / "intrinsic_depth.txt")) {
        return readScanNet(folder, options.depthOnly());
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
    for (IndexLine& line : layout.index) {
        if (layout.posePerImage && !line.baseTcamera && line.fault.empty()) {
            line.fault = "it has no pose, but other images have";
        }
    }
    return layout;
}

} // namespace fathom
