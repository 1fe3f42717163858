// SPDX-License-Identifier: Apache-2.0
#include "devices/recorded/scannet_folder.h"

#include "devices/images/depth_image.h"
#include "devices/recorded/colour_image.h"
#include "devices/recorded/matrix_file.h"
#include "devices/recorded/numbered_images.h"
#include "engine/types/error.h"

namespace fathom {

namespace {

namespace fs = std::filesystem;

std::optional<PngSize> firstColourSize(const std::vector<IndexLine>& index) {
    for (const IndexLine& line : index) {
        if (const auto size = line.colour.empty() ? std::nullopt : colourImageSize(line.colour)) {
            return size;
        }
    }
    return std::nullopt;
}

void checkIdentity(const fs::path& file) {
    if (fs::exists(file) && readMatrix(file) != kIdentityMatrix) {
        throw BadInput(file.string(), "matrix", "not the identity",
                       "the identity; or intrinsics=FILE after the folder name");
    }
}

// Both lenses, with one pose: the extrinsics are the identity.
CameraInfo scanNetCamera(const LayoutRequest& request, const std::vector<IndexLine>& index,
                         std::vector<std::string>& warnings) {
    const char* plural = request.mark.filename() == kScanNetFramesLens ? "s" : "";
    const auto file = [&](const std::string& matrix, const char* stream) {
        return request.mark.parent_path() / (matrix + plural + "_" + stream + ".txt");
    };
    CameraInfo camera;
    checkIdentity(file("extrinsic", "depth"));
    camera.depth = camera.colour = matrixLens(file("intrinsic", "depth"), firstDepthSize(index), warnings);
    if (!request.depthOnly) {
        checkIdentity(file("extrinsic", "color"));
        camera.colour = matrixLens(file("intrinsic", "color"), firstColourSize(index), warnings);
        camera.registered = false;
    }
    return camera;
}

} // namespace

RecordingLayout readScanNet(const LayoutRequest& request) {
    const fs::path& folder = request.folder;
    RecordingLayout layout;
    layout.index = pairByNumber({folder / "depth", kDepthEndings}, {folder / "color", kColourEndings},
                                request.depthOnly);
    std::vector<std::string> ofRecorded;
    const auto recorded = [&] { return scanNetCamera(request, layout.index, ofRecorded); };
    if (!request.lens) {
        layout.intrinsics.camera = recorded();
        layout.intrinsics.warnings = ofRecorded;
    } else {
        layout.intrinsics = *request.lens;
        if (!request.depthOnly) {
            keepRecordedColour(layout.intrinsics, recorded);
        }
    }
    for (IndexLine& line : layout.index) {
        layout.posePerImage |= usePose(line, folder / "pose" / (line.depth.stem().string() + ".txt"));
    }
    return layout;
}

} // namespace fathom
