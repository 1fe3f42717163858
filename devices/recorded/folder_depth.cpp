// SPDX-License-Identifier: Apache-2.0
#include "devices/recorded/folder_depth.h"

#include "devices/images/metre_units.h"
#include "devices/recorded/depth_bits.h"
#include "engine/types/error.h"
#include "engine/types/log.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace fathom {

FolderDepth::FolderDepth(const std::filesystem::path& folder, const RecordingLayout& layout,
                         const SourceOptions& options)
    : folder_(folder.string())
    , size_{layout.intrinsics.camera.depth.width, layout.intrinsics.camera.depth.height}
    , metresPerUnit_(options.scale.value_or(layout.intrinsics.camera.metresPerUnit))
    , farthest_(options.farthest)
    , invalid_(layout.invalid) {
    units_.metres = layout.metres;
    if (layout.metres) {
        options.checkMetres(folder_);
        chooseUnit(layout, options);
    } else {
        options.checkUnit(folder_);
        judgeOrder(layout);
        if (std::abs(metresPerUnit_ - 1e-3) < 1e-5 && !options.scale) {
            detectBits(layout);
        }
    }
    toAxis_ = layout.intrinsics.rangeImages ? RangeToAxis(layout.intrinsics.camera.depth) : RangeToAxis();
}

void FolderDepth::warn(const std::string& warning) {
    log::warn("{}: {}", folder_, warning);
    warnings_.push_back(warning);
}

// By the first of a few images that decides.
void FolderDepth::judgeOrder(const RecordingLayout& layout) {
    for (const std::filesystem::path& file : sampledImages(layout)) {
        const ByteOrder order = depthImageOrder(file);
        units_.swapped = order == ByteOrder::Swapped;
        if (units_.swapped) {
            warn(file.filename().string() + ": PGM has the most significant byte first, but its values are "
                                            "plausible only with the least significant one first: all depth "
                                            "images are read so");
        }
        if (order != ByteOrder::Unknown) {
            return;
        }
    }
}

void FolderDepth::detectBits(const RecordingLayout& layout) {
    const DepthBits bits = depthBits(layout, size_, units_);
    if (bits == DepthBits::Either) {
        throw BadInput(folder_, "depth images", "multiples of eight, as of coarse steps or of rotated bits",
                       "scale=0.001 after the folder name for millimetres as they are stored, or "
                       "scale=0.000125 for eighths of them, as of SUN RGB-D and the Kinect SDK");
    }
    rotated_ = bits == DepthBits::Rotated;
    if (rotated_) {
        warn("its depths are multiples of eight: read as millimetres rotated by three bits, as of SUN3D "
             "and SUN RGB-D; scale=0.001 after the folder name reads them as they are");
    } else if (bits == DepthBits::Players) {
        warn("most of its depths are multiples of eight, as of the Kinect SDK, which adds the numbers "
             "of players to eighths of millimetres; scale=0.000125 after the folder name reads "
             "them so, scale=0.001 as they are, as now");
    }
}

void FolderDepth::chooseUnit(const RecordingLayout& layout, const SourceOptions& options) {
    if (layout.statedUnit && *layout.statedUnit != 1.0 && !options.scale) {
        log::warn("{}: its depth images hold floating point, read as metres: the depth scale {} is not "
                  "applied; scale=M after the folder name is",
                  folder_, *layout.statedUnit);
    }
    ValueSpan seen;
    for (const std::filesystem::path& file : sampledImages(layout)) {
        seen.add(valueSpan(file, size_));
    }
    const double metresPerValue = options.scale.value_or(1.0);
    seen = seen.scaled(metresPerValue);
    if (const std::string warning = metresWarning(folder_, seen); !warning.empty()) { // logged already
        warnings_.push_back(warning);
    }
    metresPerUnit_ = unitForMetres(seen, options.farthest);
    units_.valuesPerUnit = metresPerUnit_ / metresPerValue;
}

void FolderDepth::dropInvalid(std::span<uint16_t> depth) const {
    if (invalid_ != 0) {
        std::replace(depth.begin(), depth.end(), invalid_, uint16_t{0});
    }
}

std::string FolderDepth::read(const std::filesystem::path& file, std::span<uint16_t> depth) {
    uint64_t beyond = 0;
    std::string fault = readDepthImage(file, size_, units_, depth, beyond);
    if (!fault.empty()) {
        return fault;
    }
    const double limit = 65535.0 * metresPerUnit_;
    if (beyond > 0 && !warnedBeyond_ && limit < farthest_) {
        warnedBeyond_ = true;
        log::warn("{}: {} pixels are farther than {:.4g} m and count as not measured", file.string(), beyond,
                  limit);
    }
    if (rotated_) {
        std::ranges::transform(depth, depth.begin(), [](uint16_t value) { return std::rotr(value, 3); });
    }
    dropInvalid(depth);
    toAxis_.convert(depth);
    return "";
}

} // namespace fathom
