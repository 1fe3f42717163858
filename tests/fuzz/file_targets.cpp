// SPDX-License-Identifier: Apache-2.0
// Targets that read files: scenes, recordings, clouds, bags.
#include "devices/bag/image_pixels.h"
#include "devices/bag/open_bag.h"
#include "devices/images/depth_image.h"
#include "devices/pcd/pcd_camera.h"
#include "devices/recorded/hand_csv.h"
#include "devices/recorded/png_image.h"
#include "devices/recorded/pose_track.h"
#include "devices/recorded/recorded_camera.h"
#include "devices/recorded/source_options.h"
#include "devices/v4l2/jpeg_image.h"
#include "engine/scene/scene.h"
#include "engine/types/error.h"
#include "tests/fuzz/fuzz_target.h"

#include <array>
#include <cmath>
#include <cstdlib>

namespace fathom::testing {

namespace {

constexpr uint32_t kMaxFrames = 8; // per input

} // namespace

void drain(Camera& camera) {
    const CameraInfo& info = camera.info();
    need(info.depth.width > 0 && info.depth.width <= kMaxImageWidth && info.depth.height <= kMaxImageHeight);
    for (uint32_t i = 0; i < kMaxFrames; ++i) {
        const auto frame = camera.next();
        if (!frame) {
            return;
        }
        need((*frame)->depth.size() >= size_t{info.depth.width} * info.depth.height);
    }
}

void readScene(Bytes input) {
    const Scene scene = loadScene(fuzzFile("scene.yaml", input));
    need(scene.nearZ < scene.farZ && scene.haptics.rateHz > 0.0 && std::isfinite(scene.errorBudget));
}

void readIndexFile(Bytes input) {
    RecordingIntrinsics lens;
    lens.camera.hasColour = true;
    const auto file = fuzzFile("associations.txt", input);
    for (const IndexLine& line : readIndex(file.parent_path(), lens)) {
        need(!line.fault.empty() || (std::isfinite(line.depthStamp) && std::isfinite(line.colourStamp)));
        need(!line.fault.empty() ||
             line.depth.lexically_normal().string().starts_with(file.parent_path().string()));
    }
    std::filesystem::remove(file);
}

void readIntrinsicsFile(Bytes input) {
    const RecordingIntrinsics lens = readIntrinsics(fuzzFile("intrinsics.json", input));
    need(lens.camera.depth.width > 0 && lens.camera.depth.width <= kMaxImageWidth);
    need(std::isfinite(lens.camera.depth.fx) && lens.camera.depth.fx > 0.0);
}

// The first byte selects a hand path or the camera's poses.
void readTracks(Bytes input) {
    if (input.empty()) {
        return;
    }
    const auto file = fuzzFile("track.txt", input.subspan(1));
    if (input[0] % 2 == 0) {
        for (const HandWaypoint& waypoint : readHandCsv(file)) {
            need(isFinite(waypoint.deviceThandle));
        }
    } else {
        const std::optional<Pose> pose = PoseTrack(file).at(0.5);
        need(!pose || isFinite(*pose));
    }
}

void readPng(Bytes input) {
    const auto file = fuzzFile("picture.png", input);
    const auto size = readPngSize(file);
    if (!size || uint64_t{size->width} * size->height > 1u << 16) {
        throw Error("no PNG, or too large to be quick");
    }
    std::vector<uint16_t> depth(size_t{size->width} * size->height);
    std::vector<uint32_t> colour(depth.size());
    const std::string noDepth = readDepthPng(file, *size, depth),
                      noColour = readColourPng(file, *size, colour);
    need(!noDepth.empty() || noColour.empty()); // 16-bit grey can be either
    need(!readDepthPng(file, {size->width + 1, size->height}, depth).empty());
}

void readDepthFile(Bytes input) {
    const auto file = fuzzFile("depth", input);
    const DepthHeader head = depthImageHeader(file);
    if (!head.fault.empty() || uint64_t{head.size.width} * head.size.height > 1u << 16) {
        throw Error(head.fault.empty() ? "too large to be quick" : head.fault);
    }
    need(head.size.width > 0 || !head.metres);
    std::vector<uint16_t> depth(size_t{head.size.width} * head.size.height);
    uint64_t beyond = 0;
    const std::string fault = readDepthImage(file, head.size, {head.metres, 0.001}, depth, beyond);
    need(depthImageOrder(file) != ByteOrder::Swapped || !head.metres);
    need(beyond <= depth.size() && std::isfinite(valueSpan(file, head.size).farthest));
    need(!readDepthImage(file, head.size, {!head.metres, 0.001}, depth, beyond).empty()); // the other kind
    if (!fault.empty()) {
        throw Error(fault);
    }
}

void readJpegImage(Bytes input) {
    std::vector<std::byte> out(mostColourBytes(ColourFormat::JpegPlanes, 16, 8));
    RawColour image;
    const std::string fault = readJpeg(std::as_bytes(input), {16, 8}, out, image);
    if (!fault.empty()) {
        throw Error("refused");
    }
    need(image.needed() <= image.bytes.size() && image.bytes.size() <= out.size());
}

void readPcdFile(Bytes input) {
    PcdCamera camera(fuzzFile("cloud.pcd", input));
    drain(camera);
}

void readPlyFile(Bytes input) {
    PcdCamera camera(fuzzFile("cloud.ply", input));
    drain(camera);
}

void readBag(Bytes input) {
    drain(*openBag(fuzzFile("recording.bag", input)));
}

void readMcap(Bytes input) {
    drain(*openBag(fuzzFile("recording.mcap", input)));
}

void readDatabase(Bytes input) {
    drain(*openBag(fuzzFile("recording.db3", input)));
}

// The first byte selects the encoding, the second the size.
void readMessageImage(Bytes input) {
    constexpr std::array kEncodings{"rgb8",
                                    "16UC1",
                                    "32FC1",
                                    "nv12",
                                    "nv21",
                                    "uyvy",
                                    "yuyv",
                                    "bayer_rggb8",
                                    "bgr16",
                                    "bayer_gbrg16",
                                    "mono8",
                                    "jpeg; rgb8",
                                    "16UC1; compressedDepth png",
                                    "16UC1; compressedDepth rvl",
                                    "32FC1; compressedDepth rvl",
                                    "bayer_rggb8; jpeg compressed ",
                                    "rgb8; jpeg compressed rgb8"};
    if (input.size() < 3) {
        throw Error("too short");
    }
    ros::Image image;
    image.format = kEncodings[input[0] % kEncodings.size()];
    image.bigEndian = input[0] >= 240;
    image.compressed = image.format.find(';') != std::string::npos;
    image.encoding = image.format.substr(0, image.format.find(';'));
    image.width = 1 + input[1] % 16;
    image.height = 1 + input[1] / 16;
    image.step = input[2];
    image.data = input.subspan(3);
    const auto size = ros::sizeOf(image);
    if (!size || uint64_t{size->first} * size->second > 1u << 16) {
        throw Error("no header, or too large to be quick");
    }
    std::vector<uint16_t> depth(size_t{size->first} * size->second);
    const ColourFormat format = ros::colourFormat(image);
    std::vector<uint32_t> colour((mostColourBytes(format, size->first, size->second) + 3) / 4);
    RawColour raw;
    uint64_t beyond = 0;
    const bool deep = ros::content(image) == ros::Content::Depth;
    const std::string fault =
        deep ? ros::depthRows(image, 0.001, depth, beyond) : ros::colourRows(image, colour, raw);
    need(beyond <= depth.size() && std::isfinite(ros::valueSpan(image).farthest));
    need(ros::depthOrder(image) == ByteOrder::Unknown || (deep && !image.compressed));
    if (!fault.empty()) {
        throw Error(fault);
    }
    need(deep || (raw.format == format && raw.needed() <= raw.bytes.size()));
}

// The options after the name of a recording.
void readSourceText(Bytes input) {
    const SourceRequest request = parseSource(std::string(input.begin(), input.end()));
    need(!request.options.scale || *request.options.scale > 0.0);
    need(request.options.start >= 0.0 && request.options.duration > 0.0);
}

} // namespace fathom::testing
