// SPDX-License-Identifier: Apache-2.0
// Reads the depth images of a recording folder as a frame's values.
#pragma once

#include "devices/images/depth_image.h"
#include "devices/recorded/range_images.h"
#include "devices/recorded/recording_layout.h"
#include "devices/recorded/source_options.h"

#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace fathom {

// One thread.
class FolderDepth {
public:
    // Images of floating point are metres, or options.scale metres per value; their unit is chosen from a few
    // images of the index: the finest that holds one and a half times the farthest depth, or
    // options.farthest. Throws BadInput for an absurd scale, and for 16 bits that hold millimetres either
    // as they are or as eighths.
    FolderDepth(const std::filesystem::path& folder, const RecordingLayout& layout,
                const SourceOptions& options);

    double metresPerUnit() const { return metresPerUnit_; }
    // That values may be read wrong. Logged already.
    const std::vector<std::string>& warnings() const { return warnings_; }
    // z in metresPerUnit(), 0 = no measurement. Returns the fault, or empty. Warns once of depth that is too
    // far for 16 bits.
    std::string read(const std::filesystem::path& file, std::span<uint16_t> depth);

private:
    void judgeOrder(const RecordingLayout& layout);
    void warn(const std::string& warning);
    void detectBits(const RecordingLayout& layout);
    void chooseUnit(const RecordingLayout& layout, const SourceOptions& options);
    void dropInvalid(std::span<uint16_t> depth) const;

    std::string folder_;
    std::vector<std::string> warnings_;
    PngSize size_;
    DepthUnits units_;
    double metresPerUnit_ = 0.0, farthest_ = 0.0; // [m]
    uint16_t invalid_ = 0;
    bool rotated_ = false; // the bits of each value are rotated to the left by three
    bool warnedBeyond_ = false;
    RangeToAxis toAxis_;
};

} // namespace fathom
