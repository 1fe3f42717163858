// SPDX-License-Identifier: Apache-2.0
#include "devices/recorded/folder_depth.h"

#include "devices/images/metre_units.h"
#include "engine/types/log.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <set>

namespace fathom {

namespace {

constexpr size_t kSamples = 9; // images of the index

// Calls visit(file) for a few images over the whole index.
template <class Visit>
void sampleImages(const RecordingLayout& layout, Visit&& visit) {
    const size_t step = std::max<size_t>(1, layout.index.size() / kSamples);
    for (size_t i = 0; i < layout.index.size(); i += step) {
        visit(layout.index[i].depth);
    }
}

// "0000001-000000033369.png": as SUN3D names its depth images.
bool namedSun3d(const std::string& name) {
    return name.size() == 24 && name.ends_with(".png") && name.find_first_not_of("0123456789") == 7 &&
           name[7] == '-' && name.find_first_not_of("0123456789", 8) == 20;
}

// How the values of a few images look if their bits are taken as rotated to the left by three.
struct RotationSigns {
    static constexpr size_t kFewestValues = 32;
    uint64_t measured = 0, beyond = 0, close = 0; // pixels; beyond 16 m, and closer than such cameras see
    bool near = false, odd = false;               // some value within 8 m, some of odd millimetres
    std::set<uint16_t> values;                    // kFewestValues at most

    void add(uint16_t value) {
        constexpr uint16_t kClosest = 250; // [mm]
        ++measured;
        beyond += (value & 7u) > 1u ? 1 : 0;
        close += std::rotr(value, 3) < kClosest ? 1 : 0;
        near = near || (value & 7u) == 0;
        odd = odd || (value & 8u) != 0;
        if (values.size() < kFewestValues) {
            values.insert(value);
        }
    }
    // As outliers may be.
    bool few(uint64_t pixels) const { return pixels * 10 <= measured; }
};

// SUN3D and SUN RGB-D rotate the bits of millimetres by three, so that nearer than 8 m all values are
// multiples of eight. So can be a few values of a plain image, and those of one with coarse steps: of eight
// millimetres, which would be too close, or of sixteen and more, without odd ones.
bool looksRotated(const RecordingLayout& layout, PngSize size) {
    std::vector<uint16_t> image(size_t{size.width} * size.height);
    RotationSigns signs;
    sampleImages(layout, [&](const std::filesystem::path& file) {
        uint64_t beyond = 0;
        if (!signs.few(signs.beyond) || !readDepthImage(file, size, {}, image, beyond).empty()) {
            return;
        }
        for (const uint16_t value : image) {
            if (value != 0 && value != layout.invalid && value != UINT16_MAX) { // no values
                signs.add(value);
            }
        }
    });
    const bool sun3d = !layout.index.empty() && namedSun3d(layout.index.front().depth.filename().string());
    const bool millimetres =
        signs.odd && signs.few(signs.close) && signs.values.size() >= RotationSigns::kFewestValues;
    return signs.near && signs.few(signs.beyond) && (sun3d || millimetres);
}

} // namespace

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
        const bool millimetres = std::abs(metresPerUnit_ - 1e-3) < 1e-5;
        rotated_ = millimetres && !options.scale && looksRotated(layout, size_);
        if (rotated_) {
            warning_ =
                "its depths are multiples of eight: read as millimetres rotated by three bits, as of SUN3D "
                "and SUN RGB-D; scale=0.001 behind the folder's name reads them as they are";
            log::warn("{}: {}", folder_, warning_);
        }
    }
    toAxis_ = layout.intrinsics.rangeImages ? RangeToAxis(layout.intrinsics.camera.depth) : RangeToAxis();
}

void FolderDepth::chooseUnit(const RecordingLayout& layout, const SourceOptions& options) {
    if (layout.statedUnit && *layout.statedUnit != 1.0 && !options.scale) {
        log::warn("{}: its depth images hold floating point, read as metres: the depth scale {} is not "
                  "applied; scale=M behind the folder's name is",
                  folder_, *layout.statedUnit);
    }
    ValueSpan seen;
    sampleImages(layout, [&](const std::filesystem::path& file) { seen.add(valueSpan(file, size_)); });
    const double metresPerValue = options.scale.value_or(1.0);
    seen = seen.scaled(metresPerValue);
    warning_ = metresWarning(folder_, seen.nearest);
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
