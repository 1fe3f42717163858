// SPDX-License-Identifier: Apache-2.0
// Depth images that hold ranges along the rays of the lens, as simulators write them.
#pragma once

#include "engine/types/camera_info.h"

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace fathom {

// Whether a topic or file is named as ranges: surely by "distance_to_camera" (Isaac Sim), "DepthPerspective"
// (AirSim), "radial_distance" and the like; perhaps by a word such as "distance" (ifm3d) or "range" (Ouster)
// without a word of depth or of a plane.
enum class RangeName { No, Perhaps, Surely };
RangeName rangeName(const std::string& name);
// Warning for images with such a name that are played as depth along the axis, empty for others. option: what
// takes them as ranges.
std::string axisWarning(const std::string& name, const std::string& option);

// Maps ranges to depth along the axis. One thread.
class RangeToAxis {
public:
    RangeToAxis() = default; // images hold depth along the axis: changes nothing
    explicit RangeToAxis(const Intrinsics& lens);
    void convert(std::span<uint16_t> ranges) const; // all pixels of the lens, in any unit

private:
    std::vector<float> axisShare_; // z of a unit step along each ray
};

} // namespace fathom
