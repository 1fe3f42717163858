// SPDX-License-Identifier: Apache-2.0
// The values of accepted scene files.
#include "tests/scene/scene_file.h"

#include <cmath>
#include <doctest/doctest.h>

using namespace fathom;

namespace {

const char* const kEverything = R"(
camera:
  source: {recorded: frames/../valve}
  near: 0.2
  far: 2.5
  base_T_camera: {xyz: [1,2,3], quat_xyzw: [0,0,2,0]}
  registration_sigma: 0.001
filter: { radius: 16, sigma: 0.02, edge: 0, isolated: keep, weights: polynomial }
error_budget: 0
hold_s: 0.25
fixtures:
  - { name: wheel, role: forbidden, hue: [345, 20], saturation: [0.45, 1], lightness: [0.05, 0.9], radius: 0.03,
      box: {min: [-1,-1,0], max: [1,1,1]} }
  - { name: body, role: guidance, hue: [55, 84], standoff: -0.01, quat_xyzw: [1,0,0,0], min_count: 7,
      largest_part: true, trim: 0.25 }
  - { name: wall, role: forbidden, shape: box, base_T_shape: {xyz: [0,0,1]}, size: [1,2,0.1] }
  - { name: room, role: keep_in, shape: sphere, size: [0.5,0,0] }
  - { name: rail, role: guidance, shape: line, base_T_shape: {quat_xyzw: [0,0,0,1]} }
tool: { file: sub/tool.sph }
hand:
  path: way.csv
  map: {base_R_device: [0,1,0,0], scale: 2.5, clutch: 8}
  loop: {mass: 0.3, damping: 0, stiffness: 400}
haptics: { rate_hz: 2000, device: w5d, stiffness: 800, rotational_stiffness: 1.5, guidance: paper, step_cap: 0.001,
  friction: 0.3, damping: 2, margin: 0.9, smooth: false,
  solves: 16, delay: 2, limits: {force: 5, torque: 0.2, slew_N_per_s: 1000, slew_Nm_per_s: 20, lowpass_hz: 300} }
contact: { where: gpu, reach: 0.02, delay: 1000 }
)";

} // namespace

TEST_CASE("A scene with only fixtures and a tool has the documented default everywhere else") {
    const SceneFile file(kMinimal);
    const Scene scene = loadScene(file.path());
    CHECK(scene.file == file.path());
    CHECK(scene.source.kind == CameraSource::Kind::Simulated);
    CHECK(scene.source.value == "tank");
    CHECK(scene.nearZ == 0.1);
    CHECK(scene.farZ == 3.0);
    CHECK(scene.baseTcamera.rotation == dquat(1, 0, 0, 0));
    CHECK(scene.filter.radius == 2);
    CHECK(scene.filter.weights == Scene::Filter::Weights::Exact);
    CHECK(scene.errorBudget == 0.0001);
    CHECK(scene.holdSeconds == 0.5);
    REQUIRE(scene.fixtures.size() == 1);
    CHECK_FALSE(scene.fixtures[0].box.has_value());
    CHECK(scene.fixtures[0].radius == 0.04);
    CHECK(scene.tool.spheres == std::vector<std::array<double, 4>>{{0, 0, 0, 0.01}});
    CHECK(scene.hand.builtIn);
    CHECK(scene.hand.clutchBit == 4);
    CHECK_FALSE(scene.haptics.stiffness.has_value());
    CHECK(scene.haptics.friction == 0.0);
    CHECK_FALSE(scene.haptics.damping.has_value());
    CHECK(scene.haptics.margin == 0.6);
    CHECK(scene.haptics.smooth);
    CHECK_FALSE(scene.haptics.forceLimit.has_value());
    CHECK(scene.contact.where == Scene::Contact::Where::Auto);
    CHECK(scene.contact.reach == 0.01);
    CHECK(scene.hasForbiddenPoints());
    CHECK_FALSE(scene.hasGuidance());
    CHECK_FALSE(scene.usesColour());
}

TEST_CASE("Classes by range and intensity are loaded as written, intensity as the lightness of grey") {
    const SceneFile file(R"(
camera: {near: 0.3, far: 8}
fixtures:
  - { name: echo, role: forbidden, range: [0.5, 6], intensity: [0.25, 0.75], radius: 0.05 }
  - { name: plain, role: forbidden, radius: 0.04 }
tool: { spheres: [[0, 0, 0, 0.01]] }
)");
    const Scene scene = loadScene(file.path());
    REQUIRE(scene.fixtures.size() == 2);
    const FixtureClass& echo = scene.fixtures[0];
    REQUIRE(echo.lightness.has_value());
    CHECK(echo.lightness->lo == 0.25);
    CHECK(echo.lightness->hi == 0.75);
    REQUIRE(echo.range.has_value());
    CHECK(echo.range->lo == 0.5);
    CHECK(echo.range->hi == 6.0);
    CHECK_FALSE(echo.hue.has_value());
    CHECK(scene.usesColour());
    CHECK_FALSE(scene.fixtures[1].lightness.has_value());
}

TEST_CASE("Camera, filter and tool are loaded as written, with paths from the scene's folder") {
    const SceneFile file(kEverything);
    std::filesystem::create_directories(file.folder() / "sub");
    std::ofstream(file.folder() / "sub/tool.sph") << "1 1\n0 0 0 0.01\n";
    const Scene scene = loadScene(file.path());
    CHECK(scene.source.kind == CameraSource::Kind::Recorded);
    CHECK(scene.source.value == (file.folder() / "valve").string());
    CHECK(scene.nearZ == 0.2);
    CHECK(scene.farZ == 2.5);
    CHECK(scene.baseTcamera.position == dvec3(1, 2, 3));
    CHECK(scene.baseTcamera.rotation == dquat(0, 0, 0, 1)); // [0,0,2,0] normalised
    CHECK(scene.registrationSigma == 0.001);
    CHECK(scene.filter.radius == 16);
    CHECK(scene.filter.edge == 0.0);
    CHECK_FALSE(scene.filter.isolated);
    CHECK(scene.filter.weights == Scene::Filter::Weights::Polynomial);
    CHECK(scene.errorBudget == 0.0);
    CHECK(scene.holdSeconds == 0.25);
    CHECK(scene.tool.file == file.folder() / "sub/tool.sph");
    CHECK(scene.hand.path == (file.folder() / "way.csv").string());
    CHECK_FALSE(scene.hand.builtIn);
}

TEST_CASE("Fixtures keep their order and every value of points and shapes") {
    const SceneFile file(kEverything);
    std::filesystem::create_directories(file.folder() / "sub");
    std::ofstream(file.folder() / "sub/tool.sph") << "1 1\n0 0 0 0.01\n";
    const Scene scene = loadScene(file.path());
    REQUIRE(scene.fixtures.size() == 5);
    const FixtureClass& wheel = scene.fixtures[0];
    CHECK(wheel.hue->lo == 345.0); // wraps through 0
    CHECK(wheel.hue->hi == 20.0);
    CHECK(wheel.lightness->hi == 0.9);
    CHECK(wheel.box->min == dvec3(-1, -1, 0));
    CHECK(wheel.radius == 0.03);
    const FixtureClass& body = scene.fixtures[1];
    CHECK(body.role == Role::Guidance);
    CHECK_FALSE(body.saturation.has_value());
    CHECK(body.standoff == -0.01);
    CHECK(body.orientation == dquat(0, 1, 0, 0));
    CHECK(body.minCount == 7);
    CHECK(body.largestPart);
    CHECK(body.trim == 0.25);
    CHECK(scene.fixtures[2].shape == ShapeKind::Box);
    CHECK(scene.fixtures[2].size == dvec3(1, 2, 0.1));
    CHECK(scene.fixtures[2].baseTshape.position == dvec3(0, 0, 1));
    CHECK_FALSE(scene.fixtures[2].keepIn);
    CHECK(scene.fixtures[3].keepIn);
    CHECK(scene.fixtures[3].size.x == 0.5);
    CHECK(scene.fixtures[4].shape == ShapeKind::Line);
    CHECK(scene.usesColour());
    CHECK(scene.hasForbiddenPoints());
    CHECK(scene.hasGuidance());
}

TEST_CASE("Hand, haptics and contact are loaded as written") {
    const SceneFile file(kEverything);
    std::filesystem::create_directories(file.folder() / "sub");
    std::ofstream(file.folder() / "sub/tool.sph") << "1 1\n0 0 0 0.01\n";
    const Scene scene = loadScene(file.path());
    CHECK(scene.hand.baseRdevice == dquat(0, 0, 1, 0));
    CHECK(scene.hand.scale == 2.5);
    CHECK(scene.hand.clutchBit == 8);
    CHECK(scene.hand.loop.mass == 0.3);
    CHECK(scene.hand.loop.damping == 0.0);
    CHECK(scene.hand.loop.stiffness == 400.0);
    CHECK(scene.haptics.rateHz == 2000.0);
    CHECK(scene.haptics.device == "w5d");
    CHECK(scene.haptics.stiffness == 800.0);
    CHECK(scene.haptics.rotationalStiffness == 1.5);
    CHECK(scene.haptics.guidance == Scene::Haptics::GuidanceMode::Paper);
    CHECK(scene.haptics.stepCap == 0.001);
    CHECK(scene.haptics.friction == 0.3);
    CHECK(scene.haptics.damping == 2.0);
    CHECK(scene.haptics.margin == 0.9);
    CHECK_FALSE(scene.haptics.smooth);
    CHECK(scene.haptics.solves == 16);
    CHECK(scene.haptics.delay == 2);
    CHECK(scene.haptics.forceLimit == 5.0);
    CHECK(scene.haptics.torqueLimit == 0.2);
    CHECK(scene.haptics.slewForce == 1000.0);
    CHECK(scene.haptics.slewTorque == 20.0);
    CHECK(scene.haptics.lowpassHz == 300.0);
    CHECK(scene.contact.where == Scene::Contact::Where::Gpu);
    CHECK(scene.contact.reach == 0.02);
    CHECK(scene.contact.delay == 1000);
}

TEST_CASE("Bounds are inclusive; an empty list of fixtures and the words auto and preset are accepted") {
    CHECK(refusal("fixtures: []\n" + kTool) == "");
    CHECK(
        refusal(
            "fixtures: [{name: a, role: forbidden, hue: [0, 360], saturation: [0, 1], lightness: [1, 1]}]\n" +
            kTool) == "");
    CHECK(refusal("fixtures: [{name: a, role: forbidden, box: {min: [0,0,0], max: [0,0,0]}}]\n" + kTool) ==
          "");
    CHECK(refusal(kMinimal + "haptics: {stiffness: auto, rotational_stiffness: auto, rate_hz: 100, step_cap: "
                             "0.05, limits: {force: preset, torque: preset}}\n") == "");
    CHECK(refusal(
              kMinimal +
              "haptics: {rate_hz: 10000, step_cap: 1e-5, solves: 1}\ncontact: {reach: 0.0001, delay: 0}\n") ==
          "");
    CHECK(refusal(kMinimal + "camera: {source: {v4l2: /dev/video0}, near: +0.5}\n") == "");
    for (const char* name : {"tank", "sphere", "plane", "torus", "slot", "gap", "plate", "corner", "sonar"}) {
        CHECK(refusal(kMinimal + "camera: {source: {simulated: " + name + "}}\n") == "");
    }
    for (const bool yuyv : {false, true}) {
        const SceneFile file(
            kMinimal + "camera: {source: {simulated: tank, colour: " + (yuyv ? "yuyv" : "rgba") + "}}\n");
        CHECK(loadScene(file.path()).source.yuyv == yuyv);
    }
}

TEST_CASE("The words true and false may be spelled as YAML 1.2 does") {
    const auto shows = [](const std::string& word) {
        return loadScene(SceneFile(kMinimal + "haptics: {smooth: " + word + "}\n").path()).haptics.smooth;
    };
    for (const char* yes : {"true", "True", "TRUE"}) {
        CHECK(shows(yes));
    }
    for (const char* no : {"false", "False", "FALSE"}) {
        CHECK_FALSE(shows(no));
    }
}

TEST_CASE("A scene uses every pixel unless it names a decimation, from 1 to 8") {
    CHECK(loadScene(SceneFile(kMinimal).path()).decimation == 1);
    CHECK(loadScene(SceneFile(kMinimal + "camera: {decimation: 8}\n").path()).decimation == 8);
    for (const char* wrong : {"0", "9", "1.5", "half"}) {
        CHECK(refusal(kMinimal + "camera: {decimation: " + wrong + "}\n").find("camera.decimation") !=
              std::string::npos);
    }
}

TEST_CASE("A quaternion of huge or tiny length is normalised without overflow") {
    for (const char* quat : {"[0, 0, 1e300, 1e300]", "[0, 0, 1e-290, 1e-290]"}) {
        const SceneFile file(kMinimal + "hand: {map: {base_R_device: " + quat + "}}\n");
        const dquat q = loadScene(file.path()).hand.baseRdevice;
        CHECK(std::abs(q.w - std::sqrt(0.5)) < 1e-15);
        CHECK(std::abs(q.z - std::sqrt(0.5)) < 1e-15);
    }
}

TEST_CASE("A flat port under water is read, and an impossible one is rejected") {
    CHECK(loadScene(SceneFile(kMinimal + "camera: {port: {distance: 0.03}}\n").path()).port->index == 1.34);
    CHECK(loadScene(SceneFile(kMinimal + "camera: {port: {distance: 0, index: 1.33}}\n").path())
              .port->distance == 0.0);
    CHECK_FALSE(loadScene(SceneFile(kMinimal).path()).port);
    CHECK(refusal(kMinimal + "camera: {port: {index: 1.33}}\n").find("distance") != std::string::npos);
    CHECK(refusal(kMinimal + "camera: {near: 0.2, port: {distance: 0.2}}\n").find("below camera.near") !=
          std::string::npos);
    CHECK(refusal(kMinimal + "camera: {port: {distance: 0.02, index: 0.9}}\n").find("1 to 2") !=
          std::string::npos);
    CHECK(refusal(kMinimal + "camera: {port: {distance: 0.02, glass: 1}}\n").find("glass") !=
          std::string::npos);
}

TEST_CASE("Only paths of a scene that leave its folder are reported") {
    const SceneFile inside(kMinimal + "hand: {path: sub/../way.csv}\ncamera: {source: {recorded: ./rec}}\n");
    CHECK(loadScene(inside.path()).outside.empty());
    const SceneFile outside(kMinimal +
                            "hand: {path: sub/../../way.csv}\ncamera: {source: {recorded: /rec}}\n");
    CHECK(loadScene(outside.path()).outside == std::vector<std::string>{"/rec", "sub/../../way.csv"});
    std::filesystem::create_symlink(outside.path(), inside.folder() / "way.csv");
    CHECK(loadScene(inside.path()).outside == std::vector<std::string>{"sub/../way.csv"});
}

TEST_CASE("Files that a camera of ROS 2 names are relative to the scene, topics are not paths") {
    const SceneFile file(kMinimal + "camera: {source: {ros2: \"depth=/a/b,intrinsics=lens.json,extrinsics="
                                    "../x.json,wait=5\"}}\n");
    const Scene scene = loadScene(file.path());
    const std::string folder = file.path().parent_path().string();
    CHECK(scene.source.kind == CameraSource::Kind::Ros2);
    CHECK(scene.source.value == "depth=/a/b,intrinsics=" + folder + "/lens.json,extrinsics=" +
                                    file.path().parent_path().parent_path().string() + "/x.json,wait=5");
    CHECK(scene.outside == std::vector<std::string>{"../x.json"});
    const SceneFile first(kMinimal + "camera: {source: {ros2: \"intrinsics=lens.json,depth=/a\"}}\n");
    CHECK(loadScene(first.path()).source.value ==
          "intrinsics=" + first.path().parent_path().string() + "/lens.json,depth=/a");
}

TEST_CASE("Files behind a recording's name are relative to the scene, as the recording is") {
    const SceneFile file(kMinimal +
                         "camera: {source: {recorded: \"a,b/rec,depth=/a/../b,intrinsics=lens.json,"
                         "extrinsics=../x.json,start=5\"}}\n");
    const Scene scene = loadScene(file.path());
    const std::string folder = file.path().parent_path().string();
    CHECK(scene.source.value == folder + "/a,b/rec,depth=/a/../b,intrinsics=" + folder +
                                    "/lens.json,extrinsics=" +
                                    file.path().parent_path().parent_path().string() + "/x.json,start=5");
    CHECK(scene.outside == std::vector<std::string>{"../x.json"});
}
