// SPDX-License-Identifier: Apache-2.0
#include "tests/rig/run_fathom.h"

#include <doctest/doctest.h>

using namespace fathom;

TEST_CASE("The help of an option names the words that it accepts") {
    CHECK(runFathom({"replay", "--help"}).out.find("--query TEXT:{cpu,gpu}") != std::string::npos);
    CHECK(runFathom({"guard", "--help"}).out.find("{falcon,haply,ros2}") != std::string::npos);
    CHECK(runFathom({"spheres", "--help"}).out.find("{x,y,z}") != std::string::npos);
}
