// SPDX-License-Identifier: Apache-2.0
// An engine and the process around it: drivers that are missing, signals, forked children.
#include "tests/engine/wall_world.h"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <doctest/doctest.h>
#include <filesystem>
#include <fstream>
#include <map>
#include <memory>
#include <string>
#include <sys/wait.h>
#include <unistd.h>

using namespace fathom;
using namespace fathom::testing;

TEST_CASE("Without a Vulkan driver engine and lockstep say in one line that the compute device is missing") {
    const Scene scene = wallScene();
    ::setenv("VK_DRIVER_FILES", "/nonexistent/driver.json", 1);
    const char* const line =
        "device: Vulkan driver: none is installed (allowed: a Vulkan 1.2 driver: install your "
        "GPU's, or mesa-vulkan-drivers, which also runs on the CPU)";
    CHECK_THROWS_WITH_AS(Engine(scene, smallCamera()), line, ComputeDeviceLost);
    CHECK_THROWS_WITH_AS(Lockstep(scene, smallCamera(), startAt(0.5)), line, ComputeDeviceLost);
    CHECK_NOTHROW(Engine(boxScene(), smallCamera())); // needs none
    ::unsetenv("VK_DRIVER_FILES");
    CHECK_NOTHROW(Engine(scene, smallCamera()));
}
