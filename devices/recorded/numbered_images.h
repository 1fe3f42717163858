// SPDX-License-Identifier: Apache-2.0
// Pairs the images of folders without an index by the numbers in their names.
#pragma once

#include "devices/recorded/recording_index.h"

#include <span>

namespace fathom {

// The files of a folder with one of these endings whose stem, in front of `before`, ends in a number; if
// there are none, those with a number in it. A warning counts the others.
struct NumberedImages {
    std::filesystem::path folder;
    std::span<const std::string_view> endings;
    std::string before = {};
};

// Depth images with their colour images, in order of their numbers, stamps 1/30 s apart. A number may have
// any length and one decimal point, as a stamp in seconds has. Pairs have the same last number, or the same
// first one (0000002-000000033369.png) if that pairs more images. Names that tell a date or a time
// (20240101_120000_333.png) are ordered and paired by all of their numbers. If fewer than half of the images
// have a partner and both folders have equally many, they are paired in order, with a warning. depthOnly:
// depth alone. Throws BadInput without a depth or a colour image, and for two images of one number.
std::vector<IndexLine> pairByNumber(const NumberedImages& depth, const NumberedImages& colour,
                                    bool depthOnly);

// The last number in the stem, without leading zeros; empty = none.
std::string imageNumber(const std::filesystem::path& file);

} // namespace fathom
