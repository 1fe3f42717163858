// SPDX-License-Identifier: Apache-2.0
#include "devices/recorded/range_images.h"

#include "engine/types/lower_case.h"

#include <algorithm>
#include <array>
#include <glm/geometric.hpp>
#include <string_view>

namespace fathom {

bool namedRangeImage(const std::string& name) {
    constexpr std::array<std::string_view, 3> kRanges{"distance_to_camera", "depthperspective",
                                                      "depth_perspective"};
    const std::string lower = lowerCase(name);
    return std::ranges::any_of(kRanges,
                               [&](std::string_view word) { return lower.find(word) != std::string::npos; });
}

std::string axisWarning(const std::string& name, const std::string& option) {
    return name +
           ": named as ranges along the rays, played as depth along the axis: \"depth_is\": \"range\" in " +
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
