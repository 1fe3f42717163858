// SPDX-License-Identifier: Apache-2.0
// Whether the first images of a camera have any depth that the scene can use.
#pragma once

#include "engine/scene/scene.h"

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace fathom {

// A wrong depth unit leaves hardly any depth between camera.near and camera.far, so no region. One thread.
class FirstDepth {
public:
    FirstDepth(const Scene& scene, double metresPerUnit) noexcept
        : near_(scene.nearZ)
        , far_(scene.farZ)
        , unit_(metresPerUnit) {}

    // Raw depths of an image. Stops where 1 % of the image is in range: for a good camera that is soon.
    void look(std::span<const uint16_t> depth) noexcept;
    // Whether 1 % of the measured depth of an image was in range.
    bool seen() const noexcept { return seen_; }
    // Why nothing is protected, if nothing was seen in the first second. `remedy`: where the unit is set.
    std::string fault(std::string_view remedy) const;

private:
    double near_, far_, unit_; // [m]; [m per raw step]
    bool seen_ = false;
    uint16_t least_ = 65535, largest_ = 0; // measured so far [raw]
    uint64_t measured_ = 0, within_ = 0;   // pixels of the images so far
};

} // namespace fathom
