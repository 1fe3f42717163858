// SPDX-License-Identifier: Apache-2.0
// Loss of swapchain and surface, simulated by a Vulkan layer: the device stays, and everything else
// continues.
#include "tests/rig/losing.h"
#include "tests/window/window_rig.h"

#include <doctest/doctest.h>
#include <filesystem>

using namespace fathom;
using namespace fathom::window;
using nlohmann::json;

TEST_CASE("Images and surfaces of the window that are lost, in any call and repeatedly, are recreated on the "
          "same device") {
    const TemporaryFolder folder;
    const std::filesystem::path trigger = folder.path() / "lose";
    const Losing losing(trigger.string(), 0);
    WindowRig rig;
    REQUIRE(rig.await([](const json& s) { return s["run"]["turns"] > 100; }));
    const double red = rig.shoot("surface-before").share(rig.place("camera"), isRed);
    CHECK(red > 0.01);
    for (const std::string call : {"acquire-outdated", "present-outdated", "surface", "surface"}) {
        CAPTURE(call);
        const json before = rig.state();
        folder.write("word", call);
        std::filesystem::rename(folder.path() / "word", trigger);
        REQUIRE(rig.await([&](const json& s) {
            return !std::filesystem::exists(trigger) &&
                   s["window"]["swapchains"] == before["window"]["swapchains"].get<int>() + 1 &&
                   s["window"]["frames"] > before["window"]["frames"].get<int>() + 5 &&
                   s["run"]["pictures"] > before["run"]["pictures"].get<int>() + 5;
        }));
        CHECK(rig.state()["gpu"]["made_anew"] == 0);
        CHECK(rig.shoot("surface-after-" + call).share(rig.place("camera"), isRed) ==
              doctest::Approx(red).epsilon(0.1));
    }
    rig.xdo("windowsize --sync $W 900 600");
    CHECK(rig.await([](const json& s) { return s["window"]["width"] == 900; }));
    const int code = rig.close();
    CHECK_MESSAGE(code == 0, rig.output());
    CHECK(rig.output().find("validation:") == std::string::npos);
}

TEST_CASE("A window that gets no new images for once is opened again on the device, and does not end") {
    const TemporaryFolder folder;
    const std::filesystem::path trigger = folder.path() / "lose";
    const Losing losing(trigger.string(), 0);
    WindowRig rig;
    REQUIRE(rig.await([](const json& s) { return s["run"]["turns"] > 100; }));
    folder.write("word", "window-used");
    std::filesystem::rename(folder.path() / "word", trigger);
    const json before = rig.state();
    rig.key("ctrl+F11");
    REQUIRE(rig.await([&](const json& s) {
        return !std::filesystem::exists(trigger) && s["gpu"]["made_anew"] == 1 && s["gpu"]["there"] == true &&
               s["window"]["frames"] > before["window"]["frames"].get<int>() + 5;
    }));
    CHECK(rig.shoot("window-used").share(rig.place("camera"), isRed) > 0.01);
    const int code = rig.close();
    CHECK_MESSAGE(code == 0, rig.output());
    CHECK(rig.output().find("validation:") == std::string::npos);
}
