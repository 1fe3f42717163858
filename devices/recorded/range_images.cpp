// SPDX-License-Identifier: Apache-2.0
#include "devices/recorded/range_images.h"

#include "devices/recorded/name_words.h"
#include "engine/types/lower_case.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <glm/geometric.hpp>
#include <string_view>

namespace fathom {

namespace {

// Whether a word of the name begins so. A capital begins a word, too.
bool hasWord(const std::string& name, std::string_view word) {
    const std::string lower = lowerCase(name);
    for (size_t at = lower.find(word); at != std::string::npos; at = lower.find(word, at + 1)) {
        const auto before = static_cast<unsigned char>(at > 0 ? name[at - 1] : '/');
        const bool capital = std::isupper(static_cast<unsigned char>(name[at])) != 0;
        if (std::isalpha(before) == 0 || (capital && std::islower(before) != 0)) {
            return true;
        }
    }
    return false;
}

} // namespace

RangeName rangeName(const std::string& name) {
    constexpr std::array<std::string_view, 3> kRanges{"distance_to_camera", "depthperspective",
                                                      "depth_perspective"};
    constexpr std::array<std::string_view, 3> kAlongRays{"radial", "euclidean", "slant"};
    constexpr std::array<std::string_view, 3> kNotRanges{"plane", "planar", "depth"};
    const std::string lower = lowerCase(name);
    const bool distance = hasWord(name, "distance") || hasWord(name, "range");
    const bool alongRays = std::ranges::any_of(kAlongRays, [&](auto word) { return hasWord(name, word); });
    if (containsAny(lower, kRanges) || (alongRays && (distance || hasWord(name, "depth")))) {
        return RangeName::Surely;
    }
    return distance && !containsAny(lower, kNotRanges) ? RangeName::Perhaps : RangeName::No;
}

std::string axisWarning(const std::string& name, const std::string& option) {
    const RangeName how = rangeName(name);
    return how == RangeName::No ? ""
                                : name + ": named as " +
                                      (how == RangeName::Surely ? "ranges along the rays"
                                                                : "what may be ranges along the rays") +
                                      ", played as depth along the axis: \"depth_is\": \"range\" in " +
                                      option + " takes them as ranges";
}

RangeToAxis::RangeToAxis(const Intrinsics& lens) {
    for (uint32_t i = 0; i < lens.pixels(); ++i) {
        const uint32_t row = i / lens.width;
        const dvec3 ray(lens.ray(i % lens.width, row), 1.0);
        axisShare_.push_back(static_cast<float>(1.0 / glm::length(ray)));
    }
}

void RangeToAxis::convert(std::span<uint16_t> ranges) const {
    for (size_t i = 0; i < axisShare_.size(); ++i) {
        ranges[i] = static_cast<uint16_t>(static_cast<float>(ranges[i]) * axisShare_[i] + 0.5f);
    }
}

} // namespace fathom
