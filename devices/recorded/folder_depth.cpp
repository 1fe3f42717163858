// SPDX-License-Identifier: Apache-2.0
#include "devices/recorded/folder_depth.h"

#include "devices/images/metre_units.h"
#include "engine/types/log.h"

#include <algorithm>
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
    }
    toAxis_ = layout.intrinsics.rangeImages ? RangeToAxis(layout.intrinsics.camera.depth) : RangeToAxis();
}

void FolderDepth::chooseUnit(const RecordingLayout& layout, const SourceOptions& options) {
    constexpr size_t kSamples = 9;
    if (layout.statedUnit && *layout.statedUnit != 1.0 && !options.scale) {
        log::warn("{}: its depth images hold floating point, read as metres: the depth scale {} is not "
                  "applied; scale=M behind the folder's name is",
                  folder_, *layout.statedUnit);
    }
    ValueSpan seen;
    const size_t step = std::max<size_t>(1, layout.index.size() / kSamples);
    for (size_t i = 0; i < layout.index.size(); i += step) {
        seen.add(valueSpan(layout.index[i].depth, size_));
    }
    const double metresPerValue = options.scale.value_or(1.0);
    seen = seen.scaled(metresPerValue);
    doubt_ = doubtMetres(folder_, seen.nearest);
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
    if (beyond > 0 && !toldBeyond_ && limit < farthest_) {
        toldBeyond_ = true;
        log::warn("{}: {} pixels are farther than {:.4g} m and count as not measured", file.string(), beyond,
                  limit);
    }
    dropInvalid(depth);
    toAxis_.convert(depth);
    return "";
}

} // namespace fathom
