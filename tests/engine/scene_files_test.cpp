// SPDX-License-Identifier: Apache-2.0
// Scenes with files that fathom-reader reads, with a flat port, and with a device without torque.
#include "tests/engine/arm_world.h"

#include <cmath>
#include <doctest/doctest.h>

using namespace fathom;
using namespace fathom::testing;

namespace {

// Presses into the wall to z = 0.56 m and returns the last step.
Step press(Lockstep& lockstep, const Wall& wall, double from = 0.5) {
    Step step;
    for (int i = 0; i < 1500; ++i) {
        const Nanoseconds t = 1'000'000 * (i + 1);
        if (i % 33 == 0) {
            lockstep.process(wall.at(t));
        }
        lockstep.queryContacts();
        step = lockstep.step(handAt(std::fmin(0.56, from + 0.0002 * i)), t);
    }
    return step;
}

std::string refusalOf(const Scene& scene, const EngineOptions& options) {
    try {
        const Lockstep lockstep(scene, smallCamera(), startAt(0.5), options);
    } catch (const Error& e) {
        return e.what();
    }
    return "";
}

} // namespace

TEST_CASE("A tool from a URDF feels the wall") {
    const ArmFolder folder;
    const Scene scene =
        folder.scene("tool: { file: ball.urdf }\nhaptics: { device: ideal, stiffness: 1000 }\n");
    Lockstep lockstep(scene, smallCamera(), startAt(0.5));
    const Step step = press(lockstep, Wall());
    CHECK(step.state == State::Contact);
    CHECK(step.wrench.force[2] == doctest::Approx(-10.0).epsilon(0.001));
}

TEST_CASE("The arm of a scene stops in front of the wall, and the self-filter removes it from the image") {
    const ArmFolder folder;
    Lockstep lockstep(folder.armScene(), smallCamera(), startAt(0.5));
    const Step step = press(lockstep, Wall());
    CHECK(step.state == State::Contact);
    CHECK(step.arm.joints[0] == doctest::Approx(0.25).epsilon(0.001)); // the ball rests at z = 0.55 m
    CHECK(step.baseTtool.position[2] == doctest::Approx(0.55).epsilon(0.001));
    CHECK(step.wrench.force[2] == doctest::Approx(-10.0).epsilon(0.001));

    Lockstep seen(folder.armScene(), smallCamera(), startAt(0.5));
    Wall wall; // and the ball, as the camera sees it at its start: without the filter it would be a region
    for (int v = 28; v < 33; ++v) {
        for (int u = 38; u < 43; ++u) {
            wall.depth[static_cast<size_t>(v * 80 + u)] = 490;
        }
    }
    seen.process(wall.at(1'000'000));
    seen.queryContacts();
    const Step first = seen.step(handAt(0.5), 1'000'000);
    CHECK(first.state == State::Free);
    CHECK(first.minGap > 0.005);
}

TEST_CASE("The reader's path comes from the options alone, and a wrong one is named in one line") {
    const ArmFolder folder;
    const Scene scene = folder.armScene();
    EngineOptions options;
    options.reader = "/nowhere/fathom-reader";
    CHECK(refusalOf(scene, options) ==
          "/nowhere/fathom-reader: cannot be started: No such file or directory (allowed: the program "
          "fathom-reader of this version)");
    options.reader = "/bin/true";
    CHECK(refusalOf(scene, options) ==
          "options: reader: /bin/true (allowed: the program fathom-reader of this version; empty = the "
          "installed one)");
    CHECK_THROWS_AS(Engine(scene, smallCamera(), options), BadInput);
    std::ofstream(folder / "slide.urdf") << "<robot>";
    CHECK_THROWS_AS(Engine(scene, smallCamera()), BadInput);
}

TEST_CASE("A scene with a flat port corrects the depth that you submit") {
    const ArmFolder folder;
    const std::string port = "{ near: 0.1, far: 3.0, port: { distance: 0.02, index: 1.33 } }";
    const Scene scene = Scene::fromText("camera: " + port + R"(
error_budget: 0
fixtures: [{ name: wall, role: forbidden, radius: 0.04 }]
tool: { spheres: [[0, 0, 0, 0.01]] }
haptics: { device: ideal, stiffness: 1000 }
)");
    Engine engine(scene, smallCamera());
    CameraPort camera = engine.camera();
    ObserverPort observer = engine.openObserver();
    const Wall wall;
    CHECK(camera.submit(wall.at(now())) == SubmitStatus::Accepted);
    Regions regions;
    REQUIRE(eventually([&] { return observer.regions(regions); }));
    REQUIRE(!regions.spheres.empty());
    // On the axis stereo measures 0.6 m for a true distance of 0.02 + 1.33 x 0.58 m.
    const RegionSphere* middle = &regions.spheres[0];
    for (const RegionSphere& sphere : regions.spheres) {
        middle =
            std::hypot(sphere.centre[0] + regions.origin[0], sphere.centre[1] + regions.origin[1]) <
                    std::hypot(middle->centre[0] + regions.origin[0], middle->centre[1] + regions.origin[1])
                ? &sphere
                : middle;
    }
    CHECK(middle->centre[2] + regions.origin[2] == doctest::Approx(0.02 + 1.33 * 0.58).epsilon(0.01));

    CameraModel curved = smallCamera();
    curved.depth.distortion[0] = 0.1;
    CHECK_THROWS_WITH_AS(Lockstep(scene, curved, startAt(0.5)),
                         doctest::Contains("camera camera: camera.port: a lens with distortion"), BadInput);
}

TEST_CASE("A device without torque gets none, and a display gets what is missing") {
    const Scene scene = Scene::fromText(R"(
camera: { near: 0.1, far: 3.0 }
error_budget: 0
fixtures: [{ name: wall, role: forbidden, radius: 0.04 }]
tool: { spheres: [[0.05, 0, 0, 0.01], [-0.05, 0, -0.05, 0.01]] }
haptics: { device: falcon }
)");
    Lockstep lockstep(scene, smallCamera(), startAt(0.5));
    const Step step = press(lockstep, Wall());
    CHECK(step.state == State::Contact);
    CHECK(step.wrench.force[2] < -0.5);
    CHECK(step.wrench.torque == Vec3{0.0, 0.0, 0.0});
    CHECK(std::abs(step.residual.torque[1]) > 1e-4);
}
