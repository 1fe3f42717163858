// SPDX-License-Identifier: Apache-2.0
// The layout of a recording folder: lens, pairs of images, poses.
#pragma once

#include "devices/images/depth_header.h"
#include "devices/recorded/pose_track.h"
#include "devices/recorded/recording_index.h"
#include "devices/recorded/source_options.h"

namespace fathom {

struct RecordingLayout {
    RecordingIntrinsics intrinsics;
    std::vector<IndexLine> index;
    std::optional<PoseTrack> poses;
    bool posePerImage = false;        // lines of the index without a pose are faulty
    uint16_t invalid = 0;             // a raw depth that means no measurement besides 0
    bool metres = false;              // depth images hold floating point, in metres
    std::optional<double> statedUnit; // [m] by the layout's files; nothing where none is stated
    std::vector<std::string> warnings = {};
};

// Header of the first depth image that can be read; of the very first one, with its fault, where none can.
DepthHeader firstDepthHeader(const std::vector<IndexLine>& index);
// Size of that image. Throws BadInput that names the first image and its fault.
PngSize firstDepthSize(const std::vector<IndexLine>& index);

// Input of the readers of a layout.
struct LayoutRequest {
    std::filesystem::path folder;
    std::optional<RecordingIntrinsics> lens; // replaces the folder's; with its scale if it states one
    bool depthOnly = false;                  // no colour is needed
    std::filesystem::path mark = {};         // the file by which the layout was recognised
};

// With intrinsics.json, or an index and options.intrinsics or a lens file of Open3D: TUM RGB-D (readIndex()),
// and poses.txt. Else: Open3D (camera_intrinsic.json, intrinsic.json, camera_primesense.json, or the options'
// lens alone; depth/ and color/, rgb/, image/ or images/ by number, millimetres), BOP (readBop()), images
// frame-N (readFrameFolder()), ScanNet (intrinsic/ or intrinsics_depth.txt, color/ and depth/ by number,
// millimetres), or FoundationPose (cam_K.txt, else as Open3D). Frames without stamps are 1/30 s apart.
// Where an image has a pose, images without one are faulty. Images of floating point need no depth scale.
// Throws BadInput.
RecordingLayout readLayout(const std::filesystem::path& folder, const SourceOptions& options);

} // namespace fathom
