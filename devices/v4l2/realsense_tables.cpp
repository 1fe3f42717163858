// SPDX-License-Identifier: Apache-2.0
#include "devices/v4l2/realsense_tables.h"

#include "devices/v4l2/inverse_distortion.h"
#include "devices/v4l2/little_endian.h"
#include "engine/types/error.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <glm/gtc/quaternion.hpp>

namespace fathom::realsense {

namespace {

constexpr size_t kHeader = 16;

double real(std::span<const uint8_t> bytes, size_t at) {
    const uint32_t bits = littleEndianWord(bytes, at);
    float value = 0.0f;
    std::memcpy(&value, &bits, sizeof value);
    return value;
}

// What follows the header: version (2 bytes), table number (2), size, parameter, checksum.
std::span<const uint8_t> body(std::span<const uint8_t> table, uint32_t number, size_t least) {
    const std::string name = "calibration table " + std::to_string(number);
    if (table.size() < kHeader + least) {
        throw Error(name + ": " + std::to_string(table.size()) + " bytes, " +
                    std::to_string(kHeader + least) + " make one");
    }
    const uint32_t size = littleEndianWord(table, 4);
    if ((littleEndianWord(table, 0) >> 16) != number || size < least || size > table.size() - kHeader) {
        throw Error(name + ": its header names table " + std::to_string(littleEndianWord(table, 0) >> 16) +
                    " with " + std::to_string(size) + " bytes");
    }
    if (crc32(table.subspan(kHeader, size)) != littleEndianWord(table, 12)) {
        throw Error(name + ": wrong checksum");
    }
    return table.subspan(kHeader, size);
}

void checkLens(const Intrinsics& lens, uint32_t number) {
    if (!(lens.fx > 0.0) || !(lens.fy > 0.0) || !std::isfinite(lens.fx + lens.fy + lens.cx + lens.cy)) {
        throw Error("calibration table " + std::to_string(number) + ": no lens of " +
                    sizeName({lens.width, lens.height}));
    }
}

} // namespace

uint32_t crc32(std::span<const uint8_t> bytes) {
    uint32_t crc = 0xffffffffu;
    for (const uint8_t byte : bytes) {
        crc ^= byte;
        for (int bit = 0; bit < 8; ++bit) {
            crc = crc >> 1 ^ (crc & 1 ? 0xedb88320u : 0u);
        }
    }
    return ~crc;
}

Intrinsics depthLens(std::span<const uint8_t> table, VideoSize size) {
    struct Row {
        VideoSize size;
        size_t index;
    };
    constexpr std::array<Row, 11> kRows{{{{1920, 1080}, 0},
                                         {{1280, 720}, 1},
                                         {{640, 480}, 2},
                                         {{848, 480}, 3},
                                         {{640, 360}, 4},
                                         {{424, 240}, 5},
                                         {{320, 240}, 6},
                                         {{480, 270}, 7},
                                         {{1280, 800}, 8},
                                         {{960, 540}, 9},
                                         {{640, 400}, 12}}};
    constexpr size_t kRectified = 240; // 16 rows of fx fy cx cy [pixels]
    const auto bytes = body(table, kDepthTable, 560);
    Row row{{1920, 1080}, 0}; // other sizes: the first row, scaled
    for (const Row& one : kRows) {
        row = one.size == size ? one : row;
    }
    const double sx = static_cast<double>(size.width) / row.size.width,
                 sy = static_cast<double>(size.height) / row.size.height;
    const size_t at = kRectified + 16 * row.index;
    Intrinsics lens{.width = size.width,
                    .height = size.height,
                    .fx = real(bytes, at) * sx,
                    .fy = real(bytes, at + 4) * sy,
                    .cx = real(bytes, at + 8) * sx,
                    .cy = real(bytes, at + 12) * sy};
    checkLens(lens, kDepthTable);
    return lens;
}

namespace {

struct Normalised {
    double fx = 0.0, cx = 0.0, fy = 0.0, cy = 0.0;
};

// The lens of an image from parameters normalised to -1..1.
Intrinsics lensOver(const Normalised& k, VideoSize size) {
    return {.width = size.width,
            .height = size.height,
            .fx = 0.5 * k.fx * size.width,
            .fy = 0.5 * k.fy * size.height,
            .cx = 0.5 * (1.0 + k.cx) * size.width,
            .cy = 0.5 * (1.0 + k.cy) * size.height};
}

// Separate colour sensor: an image of another aspect ratio is a crop of the calibrated one.
Intrinsics ownSensorLens(Normalised k, VideoSize calibrated, VideoSize size) {
    const double was = calibrated.width > 0 && calibrated.height > 0
                           ? static_cast<double>(calibrated.height) / calibrated.width
                           : 9.0 / 16.0;
    const double is = static_cast<double>(size.height) / size.width;
    (is < was ? k.fy : k.fx) *= is < was ? was / is : is / was;
    (is < was ? k.cy : k.cx) *= is < was ? was / is : is / was;
    return lensOver(k, size);
}

// The image in another size: scaled uniformly until it covers that size, then cropped symmetrically.
Intrinsics covering(const Intrinsics& lens, VideoSize size) {
    const double scale = std::max(static_cast<double>(size.width) / lens.width,
                                  static_cast<double>(size.height) / lens.height);
    return {.width = size.width,
            .height = size.height,
            .fx = lens.fx * scale,
            .fy = lens.fy * scale,
            .cx = lens.cx * scale - 0.5 * (lens.width * scale - size.width),
            .cy = lens.cy * scale - 0.5 * (lens.height * scale - size.height)};
}

// A D405 takes colour from its depth sensor of 1280x800, and its image processor crops that in other ways:
// 640x480 is the middle of 770x480, which is the whole sensor.
Intrinsics d405Lens(Normalised k, VideoSize calibrated, VideoSize size) {
    if (size == VideoSize{1280, 720}) {
        return lensOver(k, size);
    }
    if (calibrated.width == 0 || calibrated.height == 0) {
        throw Error("calibration table " + std::to_string(kColourTable) + ": no size that it is for");
    }
    if (size != VideoSize{640, 480}) {
        return covering(lensOver(k, calibrated), size);
    }
    constexpr VideoSize kSensor{1280, 800}, kScaled{770, 480};
    k.fy *= static_cast<double>(calibrated.height) / kSensor.height;
    k.cy *= static_cast<double>(calibrated.height) / kSensor.height;
    Intrinsics lens = covering(lensOver(k, kSensor), kScaled);
    lens.cx -= 0.5 * (kScaled.width - size.width);
    lens.width = size.width;
    return lens;
}

} // namespace

ColourTable colourLens(std::span<const uint8_t> table, VideoSize size, ColourSensor sensor) {
    const auto bytes = body(table, kColourTable, 216);
    const Normalised k{real(bytes, 0), real(bytes, 8), real(bytes, 16), real(bytes, 20)};
    const uint32_t both = littleEndianWord(bytes, 128); // width, height: 16 bits each
    const VideoSize calibrated{both & 0xffff, both >> 16};
    ColourTable colour;
    colour.lens =
        sensor == ColourSensor::D405 ? d405Lens(k, calibrated, size) : ownSensorLens(k, calibrated, size);
    checkLens(colour.lens, kColourTable);
    std::array<double, 5> inverseCoefficients{};
    glm::dmat3 rotation;
    for (size_t i = 0; i < 9; ++i) {
        rotation[static_cast<glm::length_t>(i / 3)][static_cast<glm::length_t>(i % 3)] =
            real(bytes, 168 + 4 * i);
    }
    for (size_t i = 0; i < 5; ++i) {
        inverseCoefficients[i] = real(bytes, 36 + 4 * i);
    }
    colour.lens.distortion = forwardDistortion(colour.lens, inverseCoefficients);
    const dvec3 shift = -0.001 * dvec3(real(bytes, 204), real(bytes, 208), real(bytes, 212));
    // The table's pose maps colour to depth (it is registered from colour to depth).
    colour.colourTdepth = inverse(Pose{shift, glm::normalize(glm::quat_cast(rotation))});
    const auto& bend = colour.lens.distortion;
    if (!isFinite(colour.colourTdepth) ||
        !std::all_of(bend.begin(), bend.end(), [](double one) { return std::isfinite(one); })) {
        throw Error("calibration table " + std::to_string(kColourTable) +
                    ": distortion or pose is not finite");
    }
    return colour;
}

} // namespace fathom::realsense
