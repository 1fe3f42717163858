// SPDX-License-Identifier: Apache-2.0
// What the tests' organised cloud of 9 columns is played as, whatever its format.
#pragma once

#include "devices/pcd/pcd_camera.h"

#include <doctest/doctest.h>

namespace fathom::testing {

inline void checkOrganisedCloud(const std::filesystem::path& file) {
    PcdCamera camera(file);
    const CameraInfo& info = camera.info();
    CHECK(info.depth.width == 9);
    CHECK(info.depth.fx == doctest::Approx(10.0).epsilon(1e-3));
    CHECK(info.depth.fy == doctest::Approx(11.0).epsilon(1e-3));
    CHECK(info.depth.cx == doctest::Approx(4.25).epsilon(1e-3));
    CHECK(info.depth.cy == doctest::Approx(3.5).epsilon(1e-3));
    const auto frame = camera.next();
    REQUIRE(frame);
    CHECK((*frame)->depth[0] == 0);
    CHECK((*frame)->depth[8] == 14000);
    CHECK((*frame)->colour[1] == 0xff312010u);
    CHECK_FALSE(camera.next());
}

} // namespace fathom::testing
