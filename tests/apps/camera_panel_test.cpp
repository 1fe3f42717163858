// SPDX-License-Identifier: Apache-2.0
// The tab of the camera, driven by the mouse, with a camera made by the test.
#include "tests/apps/laid_screen.h"

#include <chrono>
#include <doctest/doctest.h>
#include <mutex>
#include <thread>

using namespace fathom;
using namespace fathom::operate;

namespace {

// Exposure 10 to 100 in steps of 5, fixed while auto exposure is on; a gain that it lacks.
class MadeControls final : public CameraControls {
public:
    std::vector<CameraControl> read() override {
        const std::lock_guard lock(mutex_);
        CameraControl automatic{"depth", "auto exposure", ""}, exposure{"depth", "exposure", "x 0.1 ms"},
            gain{"depth", "gain", ""};
        automatic.isSwitch = true;
        automatic.most = 1;
        automatic.value = automatic_ ? 1 : 0;
        exposure.least = 10, exposure.most = 100, exposure.step = 5, exposure.value = exposure_;
        exposure.fixed = automatic_ ? "switch off auto exposure" : "";
        gain.fixed = "not offered by the camera's driver";
        return {automatic, exposure, gain};
    }
    std::string set(const CameraControl& control, int64_t value) override {
        const std::lock_guard lock(mutex_);
        if (control.name == "auto exposure") {
            automatic_ = value != 0;
        } else {
            exposure_ = value;
        }
        return value == 100 ? "depth exposure was not set: Device or resource busy" : "";
    }

private:
    std::mutex mutex_;
    bool automatic_ = true;
    int64_t exposure_ = 20;
};

struct CameraRig {
    testing::LaidScreen laid;
    CameraControlThread controlThread{std::make_shared<MadeControls>()};
    CameraFacts camera{"camera Made", {{"depth", 640, 480, 30.0, "Z16"}}, true, false};

    CameraRig() {
        laid.camera = &camera;
        laid.controlThread = &controlThread;
        laid.run.console.panels.tab = Tab::Camera;
        laid.loadFontsFor({1280, 720}, 1.0);
        laid.draw();
        controlThread.show(true);
    }
    // Draws until the camera's answer satisfies `wanted`.
    bool await(const std::function<bool(const std::vector<CameraControl>&)>& wanted) {
        for (int i = 0; i < 2000; ++i) {
            const CameraControlThread::Answer answer = controlThread.answer();
            laid.draw(1);
            if (answer.known && wanted(answer.controls)) {
                laid.draw(2);
                return true;
            }
            std::this_thread::sleep_for(std::chrono::milliseconds(5));
        }
        return false;
    }
    // Presses the mouse at one share of the width of a place and releases it at another.
    void drag(const std::string& name, float from, float to) {
        const auto place = laid.run.console.places.at(name);
        const float y = place[1] + 0.5f * place[3];
        ImGuiIO& io = ImGui::GetIO();
        io.MousePos = {place[0] + from * place[2], y};
        laid.draw(2);
        io.MouseDown[0] = true;
        laid.draw(2);
        io.MousePos = {place[0] + to * place[2], y};
        laid.draw(2);
        io.MouseDown[0] = false;
        laid.draw(2);
    }
};

int64_t exposureIn(const std::vector<CameraControl>& controls) {
    return controls[1].value;
}

} // namespace

TEST_CASE("A click switches auto exposure off, then a slider sets the exposure in the camera's steps") {
    CameraRig rig;
    REQUIRE(rig.await([](const auto& c) { return c.size() == 3; }));
    CHECK(rig.controlThread.answer().controls[1].fixed == "switch off auto exposure");
    rig.drag("depth exposure", 0.2f, 0.8f); // greyed
    rig.drag("depth auto exposure", 0.05f, 0.05f);
    REQUIRE(rig.await([](const auto& c) { return c[0].value == 0 && c[1].fixed.empty(); }));
    CHECK(exposureIn(rig.controlThread.answer().controls) == 20);
    rig.drag("depth exposure", 0.1f, 0.5f);
    REQUIRE(rig.await([](const auto& c) { return exposureIn(c) > 40; }));
    CHECK(exposureIn(rig.controlThread.answer().controls) % 5 == 0);
    CHECK(exposureIn(rig.controlThread.answer().controls) < 70);
    rig.drag("depth exposure", 0.5f, 1.2f);
    REQUIRE(rig.await([](const auto& c) { return exposureIn(c) == 100; }));
    CHECK(rig.controlThread.answer().fault == "depth exposure was not set: Device or resource busy");
}

TEST_CASE("The controls of a camera are read only while its tab is shown") {
    CameraRig rig;
    REQUIRE(rig.await([](const auto& c) { return c.size() == 3; }));
    rig.controlThread.show(false);
    CHECK(!rig.controlThread.answer().known);
    rig.controlThread.show(true);
    CHECK(rig.await([](const auto& c) { return c.size() == 3; }));
}

TEST_CASE("A source without controls says so, and how old a frame is when forces first use it") {
    ViewedRun run;
    CameraControlThread none(nullptr);
    CHECK(whyNoControls({}, none) == "A recording or simulation has no exposure, gain or laser to set.");
    CHECK(!none.any());
    for (int frame = 0; frame < 3; ++frame) {
        for (int tick = 0; tick < 33; ++tick) {
            run.row.record.frame = frame;
            run.row.record.sceneAge = 0.020 + 0.010 * frame + 0.001 * tick;
            run.step(0.001);
        }
    }
    CHECK(run.view.delay().median == doctest::Approx(0.030));
    CHECK(run.view.delay().worst == doctest::Approx(0.040));
    for (int tick = 0; tick < 1200; ++tick) {
        run.step(0.001);
    }
    CHECK(std::isnan(run.view.delay().median));
}
