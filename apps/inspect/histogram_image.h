// SPDX-License-Identifier: Apache-2.0
// The histograms of `fathom inspect` as an image.
#pragma once

#include "apps/inspect/hue_study.h"

#include <filesystem>
#include <vector>

namespace fathom {

// Bars of equal width [m] from `low` [m] on; the last one counts everything beyond.
struct DepthBars {
    double low = 0.0, width = 0.0;
    std::vector<uint64_t> counts;
};

// Depth on the left; hue in its own colours on the right, where `hues` is not null. Throws Error that names
// the file.
void drawHistograms(const DepthBars& depth, const HueStudy* hues, const std::filesystem::path& file);

} // namespace fathom
