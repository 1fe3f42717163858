// SPDX-License-Identifier: Apache-2.0
#include "devices/recorded/recording_layout.h"

#include "devices/images/depth_image.h"
#include "devices/recorded/bop_folder.h"
#include "devices/recorded/colour_image.h"
#include "devices/recorded/depth_scale.h"
#include "devices/recorded/frame_folder.h"
#include "devices/recorded/matrix_file.h"
#include "devices/recorded/numbered_images.h"
#include "devices/recorded/range_images.h"
#include "devices/recorded/scannet_folder.h"
#include "devices/recorded/unknown_folder.h"
#include "engine/types/error.h"
#include "engine/types/log.h"

#include <algorithm>
#include <cmath>
#include <iterator>

namespace fathom {

namespace {

namespace fs = std::filesystem;

// Names of the folder of colour images, beside depth/.
constexpr std::array kColourFolders{"color", "rgb", "image", "images"};

std::optional<fs::path> colourFolder(const fs::path& folder) {
    for (const char* name : kColourFolders) {
        if (fs::exists(folder / name)) {
            return folder / name;
        }
    }
    return std::nullopt;
}

constexpr const char *kMatrixLens = "cam_K.txt", *kOwnLens = "intrinsics.json";

// The registered lens of other programs where the file has none that is read. Throws BadInput for kOwnLens.
CameraInfo recordedCamera(const fs::path& mark) {
    if (mark.filename() == kOwnLens) {
        return readIntrinsics(mark, ScaleRule::Unchecked).camera;
    }
    try {
        return fs::is_regular_file(mark) ? readIntrinsics(mark, ScaleRule::Optional).camera : CameraInfo{};
    } catch (const BadInput&) {
        return {};
    }
}

void checkColourFolder(const LayoutRequest& request) {
    if (!request.depthOnly && !colourFolder(request.folder)) {
        throw BadInput(request.folder.string(), "colour images", "none",
                       "a folder color, rgb, image or images, or colour=none after the folder name");
    }
}

// Of depth/ and the folder of colour.
std::vector<IndexLine> numberedPairs(const LayoutRequest& request) {
    return pairByNumber(
        {request.folder / "depth", kDepthEndings},
        {colourFolder(request.folder).value_or(request.folder / kColourFolders[0]), kColourEndings},
        request.depthOnly);
}

RecordingLayout readOpen3d(const LayoutRequest& request) {
    checkColourFolder(request);
    RecordingLayout layout;
    layout.intrinsics = request.lens ? *request.lens : readIntrinsics(request.mark, ScaleRule::Optional);
    if (request.lens && !request.depthOnly) {
        keepRecordedColour(layout.intrinsics, [&] { return recordedCamera(request.mark); });
    }
    if (request.lens && fs::is_regular_file(request.mark)) {
        keepRecordedUnit(layout.intrinsics, request.mark.filename().string(),
                         [&] { return scaleIn(request.mark); });
    }
    layout.index = numberedPairs(request);
    return layout;
}

// FoundationPose and BundleSDF: one lens for registered images, in millimetres.
RecordingLayout readMatrixFolder(const LayoutRequest& request) {
    checkColourFolder(request);
    RecordingLayout layout;
    layout.index = numberedPairs(request);
    RecordingIntrinsics& intrinsics = layout.intrinsics;
    intrinsics.file = kMatrixLens;
    intrinsics.camera.depth = intrinsics.camera.colour =
        matrixLens(request.folder / kMatrixLens, firstDepthSize(layout.index), intrinsics.warnings);
    return layout;
}

// Depth scales are for integers.
bool holdsMetres(const RecordingLayout& layout) {
    const DepthHeader head = firstDepthHeader(layout.index);
    return head.fault.empty() && head.metres;
}

bool statesUnit(const fs::path& file) {
    try {
        return scaleIn(file).has_value();
    } catch (const BadInput&) {
        return false;
    }
}

// own: the folder's file of lenses, which `intrinsics` may replace; empty = none.
RecordingLayout readTum(const fs::path& folder, const fs::path& intrinsics, const fs::path& own,
                        bool depthOnly, ScaleRule rule = ScaleRule::Needed) {
    const bool replaced = !own.empty() && own != intrinsics;
    rule = replaced && statesUnit(own) ? ScaleRule::Optional : rule;
    RecordingLayout layout;
    layout.intrinsics = readIntrinsics(intrinsics, ScaleRule::Unchecked);
    layout.index = readIndex(folder, layout.intrinsics, depthOnly);
    if (!holdsMetres(layout)) {
        layout.intrinsics = readIntrinsics(intrinsics, rule);
    }
    if (replaced && own.filename() == kOwnLens && !depthOnly) {
        keepRecordedColour(layout.intrinsics,
                           [&] { return readIntrinsics(own, ScaleRule::Unchecked).camera; });
    }
    if (replaced) {
        keepRecordedUnit(layout.intrinsics, own.filename().string(), [&] { return scaleIn(own); });
    }
    if (fs::exists(folder / "poses.txt")) {
        layout.poses.emplace(folder / "poses.txt");
    }
    return layout;
}

// The lens of Open3D next to an index.
RecordingLayout readIndexedOpen3d(const fs::path& folder, const fs::path& mark,
                                  const SourceOptions& options) {
    RecordingLayout layout = readTum(folder, mark, {}, options.depthOnly(), ScaleRule::Optional);
    if (!layout.metres && !layout.intrinsics.scale && !options.scale) {
        layout.warnings.push_back(mark.filename().string() +
                                  " states no depth scale: millimetres are assumed, but depth of TUM RGB-D "
                                  "has 5000 units per metre (scale=0.0002 after the folder name)");
    }
    return layout;
}

struct KnownLayout {
    const char* mark; // file that only this layout has
    RecordingLayout (*read)(const LayoutRequest&);
    const char* companion = ""; // folder without which the mark is that of another program
};
constexpr std::array kLayouts{KnownLayout{"camera_intrinsic.json", readOpen3d},
                              KnownLayout{"intrinsic.json", readOpen3d},
                              KnownLayout{"camera_primesense.json", readOpen3d},
                              KnownLayout{"scene_camera.json", readBop},
                              KnownLayout{"intrinsic/intrinsic_depth.txt", readScanNet},
                              KnownLayout{kScanNetFramesLens, readScanNet, "color"}};

// read: null for none of them.
KnownLayout layoutOf(const fs::path& folder) {
    for (const KnownLayout& layout : kLayouts) {
        if (fs::exists(folder / layout.mark) && fs::exists(folder / layout.companion)) {
            return layout;
        }
    }
    return {"", hasFrameImages(folder) ? readFrameFolder : nullptr};
}

bool hasIndex(const fs::path& folder, bool depthOnly = true) {
    return fs::exists(folder / "associations.txt") ||
           (fs::exists(folder / "depth.txt") && (depthOnly || fs::exists(folder / "rgb.txt")));
}

// Not with an index, as of TUM RGB-D, whose depth rarely is in millimetres.
bool isMatrixFolder(const fs::path& folder) {
    return fs::exists(folder / kMatrixLens) && fs::exists(folder / "depth") && !hasIndex(folder);
}

bool isRecordingFolder(const fs::path& folder) {
    return fs::exists(folder / kOwnLens) || layoutOf(folder).read != nullptr || isMatrixFolder(folder);
}

bool hasStamps(const fs::path& lens) {
    try {
        return !readIntrinsics(lens, ScaleRule::Unchecked).depthStamps.empty();
    } catch (const BadInput&) {
        return false;
    }
}

// Whether nothing but their numbers tells which images belong together. lens: a given one.
bool hasNumbersOnly(const fs::path& folder, const fs::path& lens) {
    return fs::exists(folder / "depth") && !hasIndex(folder) && !hasStamps(lens) &&
           !hasStamps(folder / kOwnLens);
}

RecordingLayout readFolder(const fs::path& folder, const SourceOptions& options) {
    const bool given = !options.intrinsics.empty(), own = fs::exists(folder / kOwnLens);
    const fs::path intrinsics = given ? options.intrinsics : folder / kOwnLens;
    const KnownLayout known = layoutOf(folder);
    const bool numbered = given && known.read == nullptr && hasNumbersOnly(folder, intrinsics);
    if ((own && !numbered) || (given && hasIndex(folder))) {
        const fs::path recorded = own                        ? folder / kOwnLens
                                  : known.read == readOpen3d ? folder / known.mark
                                                             : fs::path();
        return readTum(folder, intrinsics, recorded, options.depthOnly());
    }
    if (!given && known.read == readOpen3d && hasIndex(folder, options.depthOnly())) {
        return readIndexedOpen3d(folder, folder / known.mark, options);
    }
    const bool replaced = own && fs::weakly_canonical(intrinsics) != fs::weakly_canonical(folder / kOwnLens);
    LayoutRequest request{folder, std::nullopt, options.depthOnly(),
                          folder / (replaced ? kOwnLens : known.mark)};
    if (given) {
        request.lens = readIntrinsics(intrinsics, ScaleRule::Optional);
        request.depthOnly |= !request.lens->camera.hasColour;
    }
    if (known.read != nullptr) {
        return known.read(request);
    }
    if (given && request.lens->depthStamps.empty() && fs::exists(folder / "depth") &&
        (request.depthOnly || colourFolder(folder))) {
        return readOpen3d(request); // images that pair by number
    }
    if (given && request.lens->depthStamps.empty()) {
        refuseMisplacedDepth(folder);
    }
    if (given) { // its stamps may be the index
        return readTum(folder, intrinsics, {}, options.depthOnly());
    }
    if (isMatrixFolder(folder)) {
        return readMatrixFolder(request);
    }
    refuseUnknownFolder(folder, isRecordingFolder);
}

// Simulators write both kinds of depth, under names that tell them apart.
void warnAboutAxis(const RecordingLayout& layout, const fs::path& folder) {
    if (layout.index.empty() || layout.intrinsics.rangeImages) {
        return;
    }
    const std::string first = layout.index.front().depth.lexically_relative(folder).string();
    if (const std::string warning = axisWarning(first, "the file of the lens"); !warning.empty()) {
        log::warn("{}/{}", folder.string(), warning);
    }
}

} // namespace

DepthHeader firstDepthHeader(const std::vector<IndexLine>& index) {
    std::optional<DepthHeader> first;
    for (const IndexLine& line : index) {
        if (!line.fault.empty()) {
            continue;
        }
        DepthHeader head = depthImageHeader(line.depth);
        if (head.fault.empty()) {
            return head;
        }
        first = first ? first : std::optional(std::move(head));
    }
    return first.value_or(DepthHeader{.fault = "no usable pair of images"});
}

PngSize firstDepthSize(const std::vector<IndexLine>& index) {
    const DepthHeader head = firstDepthHeader(index);
    if (!head.fault.empty()) {
        throw BadInput(index.front().depth.string(), "image", head.fault, "one depth image that can be read");
    }
    return head.size;
}

RecordingLayout readLayout(const fs::path& folder, const SourceOptions& options) {
    RecordingLayout layout = readFolder(folder, options);
    layout.metres = holdsMetres(layout);
    layout.statedUnit = layout.intrinsics.scale;
    if (!layout.metres && !layout.statedUnit && !options.scale && !layout.intrinsics.unreadScale.empty()) {
        throw BadInput(layout.intrinsics.unreadScale);
    }
    if (!layout.metres && !options.scale && !layout.intrinsics.unitWarning.empty()) {
        layout.warnings.push_back(layout.intrinsics.unitWarning);
    }
    warnAboutAxis(layout, folder);
    std::ranges::copy(layout.intrinsics.warnings, std::back_inserter(layout.warnings));
    for (IndexLine& line : layout.index) {
        if (layout.posePerImage && !line.baseTcamera && line.fault.empty()) {
            line.fault = "it has no pose, but other images have";
        }
    }
    if (const std::string fast = fastPoses(layout.index); !fast.empty()) {
        layout.warnings.push_back(fast);
    }
    return layout;
}

} // namespace fathom
