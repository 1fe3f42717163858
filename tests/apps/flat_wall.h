// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "engine/contact/host_fixtures.h"

namespace fathom::operate {

// A wall 1 m in front of a camera of 64 x 48 pixels with a focal length of 60 pixels; no regions.
inline HostFixtures flatWall() {
    HostFixtures set;
    set.camera.depth.width = 64, set.camera.depth.height = 48;
    set.camera.depth.fx = set.camera.depth.fy = 60.0;
    set.camera.depth.cx = 31.5, set.camera.depth.cy = 23.5;
    set.camera.metresPerUnit = 0.001;
    set.depth.assign(size_t{64} * 48, 1000);
    return set;
}

inline void addRegion(HostFixtures& set, const dvec3& centre, double radius, uint8_t fixture) {
    RegionSpheres& s = set.spheres;
    s.resize(s.size() + 1);
    s.x.back() = static_cast<float>(centre.x), s.y.back() = static_cast<float>(centre.y);
    s.z.back() = static_cast<float>(centre.z), s.radius.back() = static_cast<float>(radius);
    s.fixture.back() = fixture;
}

} // namespace fathom::operate
