// SPDX-License-Identifier: Apache-2.0
// Whether the first images of a camera have any depth that the scene can use.
#pragma once

#include "engine/scene/scene.h"
#include "engine/types/camera_info.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace fathom {

// A wrong depth unit leaves hardly any depth between camera.near and camera.far, so no region. One thread.
class FirstDepth {
public:
    FirstDepth(const Scene& scene, const CameraInfo& camera) noexcept
        : near_(scene.nearZ)
        , far_(scene.farZ)
        , unit_(camera.metresPerUnit)
        , width_(std::max(1u, camera.depth.width)) {}

    // Raw depths of an image. Stops where enough of the image is in range: for a good camera that is soon.
    void look(std::span<const uint16_t> depth) noexcept;
    // Whether 1 % of the measured depth of an image was in range, or 0.01 % on surfaces.
    bool seen() const noexcept { return seen_; }
    // Why nothing is protected, if nothing was seen in the first second. `remedy`: where the unit is set.
    std::string fault(std::string_view remedy) const;

private:
    bool inRange(uint16_t raw) const noexcept;
    bool onSurface(std::span<const uint16_t> depth, size_t pixel) const noexcept;

    double near_, far_, unit_; // [m]; [m per raw step]
    size_t width_;             // of an image [pixels]
    bool seen_ = false;
    uint16_t least_ = 65535, largest_ = 0; // measured so far [raw]
    uint64_t measured_ = 0, within_ = 0;   // pixels of the images so far
};

} // namespace fathom
