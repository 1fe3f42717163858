// SPDX-License-Identifier: Apache-2.0
// Organised point clouds in PCD files: ascii, binary and LZF-compressed. Source: the PCD format's page of the
// Point Cloud Library's documentation; LZF: the format of liblzf.
#pragma once

#include "engine/types/pose.h"

#include <cmath>
#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

namespace fathom {

// The fields in use; each column that is not empty has one value per point.
struct PcdCloud {
    uint32_t width = 0, height = 0;
    std::vector<dvec3> points;    // [m] row-major; not finite where nothing was measured
    std::vector<uint32_t> colour; // 0xAABBGGRR; empty without fields rgb, rgba, or r, g, b
    std::vector<float> intensity; // empty without a field intensity
    std::string uncoloured = {};  // why `colour` is empty, where the file's kind says more
    std::string pose = {}; // where the file states a pose of its sensor, which is not read; empty = nowhere
};

// p: in the camera's optical axes.
inline bool isMeasured(const dvec3& p) noexcept {
    return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z) && p.z > 0.0;
}

// Throws BadInput naming the file and the header's line, also for a cloud that is not organised (height 1).
PcdCloud readPcd(const std::filesystem::path& file);

// LZF; out has the unpacked size. False when the result has another size.
bool unpackLzf(std::span<const uint8_t> in, std::span<uint8_t> out);

} // namespace fathom
