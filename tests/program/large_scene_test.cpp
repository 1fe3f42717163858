// SPDX-License-Identifier: Apache-2.0
// Lengths that are likely millimetres: tool, hand path and arm.
#include "tests/rig/arm_stage.h"
#include "tests/rig/program_refusal.h"

#include <doctest/doctest.h>

using namespace fathom;
using namespace fathom::testing;

namespace {

// Standard error of `plan`.
std::string planWarnings(const Stage& stage, const SceneText& scene) {
    stage.scene(scene);
    const ProgramRun run =
        runFathom({"plan", (stage / "scene.yaml").string(), "--source", (stage / "rec").string()});
    CHECK(run.exitCode == 0);
    return run.err;
}

bool asksForUnit(const std::string& warnings, const std::string& what) {
    INFO(warnings);
    return warnings.find(what) != std::string::npos &&
           warnings.find(" m (is the value in millimetres?)") != std::string::npos;
}

// An arm of two links with a shape on the second one, at this place in its joint.
std::string twoLinks(const std::string& place, const std::string& shape) {
    const std::string ball = "<collision><geometry><sphere radius='0.02'/></geometry></collision></link>";
    return "<robot name='r'><link name='a'>" + ball + "<link name='b'><collision><geometry>" + shape +
           "</geometry></collision></link><joint name='j' type='revolute'><parent link='a'/><child "
           "link='b'/><origin xyz='" +
           place +
           "'/><axis xyz='0 1 0'/><limit effort='1' velocity='1' lower='-1' upper='1'/></joint></robot>";
}

} // namespace

TEST_CASE("A tool, a hand path and an arm as large as in millimetres are questioned by plan and replay") {
    const Stage stage;
    stage.recording({bumpImage()});
    stage.hand({{0.0, {0.0, 0.0, 0.0}}, {0.1, {0.0, 0.0, 9.0}}});
    SceneText scene;
    scene.hand = "path: hand.csv";
    CHECK(planWarnings(stage, scene) == "");
    const std::string pose = scene.camera;
    scene.camera += ", base_T_camera: {xyz: [0, 0, 450]}";
    CHECK(asksForUnit(planWarnings(stage, scene), "camera.base_T_camera: reaches 450 m"));
    scene.camera = pose;
    stage.write("rec/poses.txt", "0 0 0 0 0 0 0 1\n0.5 0.4 0 0 0 0 0 1\n1 0.4 30 0 0 0 0 1\n");
    CHECK(planWarnings(stage, scene)
              .find("poses.txt: at 1.000000 s the camera moves 30 m in 0.5 s (millimetres, "
                    "other seconds, or a jump of the tracking?)") != std::string::npos);
    std::filesystem::remove(stage / "rec" / "poses.txt");
    scene.tool = "spheres: [[0, 0, 40, 8], [10, 0, 20, 5]]";
    CHECK(asksForUnit(planWarnings(stage, scene), "tool: reaches 48 m"));
    stage.write("tool.yaml", "collision_spheres: {hand: [{center: [0, 0, 1.5], radius: 0.6}]}\n");
    scene.tool = "file: tool.yaml";
    CHECK(asksForUnit(planWarnings(stage, scene), "tool.yaml: tool: reaches 2.1 m"));
    scene = {};
    scene.hand = "path: hand.csv";
    scene.fixtures = {
        "name: near, role: forbidden, radius: 4",
        "name: bench, role: forbidden, shape: box, size: [400, 300, 50], base_T_shape: {xyz: [0, 0, 700]}"};
    CHECK(asksForUnit(planWarnings(stage, scene), "fixtures: near: radius: reaches 4 m"));
    CHECK(asksForUnit(planWarnings(stage, scene), "fixtures: bench: base_T_shape: reaches 700 m"));
    CHECK(asksForUnit(planWarnings(stage, scene), "fixtures: bench: size: reaches 400 m"));
    scene = {};
    scene.hand = "path: hand.csv";
    stage.hand({{0.0, {0.0, 0.0, -1.0}}, {1.0, {0.0, 0.0, 99.0}}});
    CHECK(asksForUnit(planWarnings(stage, scene), "hand.csv: the hand moves 100 m"));
    CHECK(asksForUnit(runFathom(stage.command()).err, "hand.csv: the hand moves 100 m"));
    scene.hand = "path: hand.csv, map: {scale: 0.001}";
    CHECK(planWarnings(stage, scene) == "");
    scene.hand = "path: hand.csv";
    stage.hand({{0.0, {0.0, 0.0, 487.6}}, {1.0, {0.0, 0.0, 496.6}}});
    CHECK(asksForUnit(planWarnings(stage, scene),
                      "hand.csv: what the camera sees and the hand's way are apart by 484"));
    stage.hand({{0.0, {0.0, 0.0, 8.0}}, {1.0, {0.0, 0.0, 9.0}}});
    CHECK(planWarnings(stage, scene) == "");
    stage.write("arm.urdf", twoLinks("0 0 25", "<sphere radius='0.05'/>"));
    scene.more = "arm: {urdf: arm.urdf}\n";
    CHECK(asksForUnit(planWarnings(stage, scene), "arm.urdf: the arm reaches 25"));
}

TEST_CASE("An arm beyond what contact queries take is rejected by plan too, with URDF, link and lengths") {
    const Stage stage;
    stage.recording({bumpImage()});
    SceneText scene;
    scene.more = "arm: {urdf: arm.urdf}\n";
    stage.scene(scene);
    for (const auto& [place, shape, value] :
         {std::tuple{"0 0 1e9", "<sphere radius='0.05'/>", "(0, 0, 1e+09) m, of radius 0.05 m"},
          {"0 0 51", "<sphere radius='0.05'/>", "(0, 0, 51) m, of radius 0.05 m"},
          {"0 0 1", "<sphere radius='11'/>", "(0, 0, 1) m, of radius 11 m"},
          {"0 0 1", "<box size='300 300 300'/>", "m, of radius "}}) {
        stage.write("arm.urdf", twoLinks(place, shape));
        const std::vector<std::string> parts{
            "arm.urdf: link b: a sphere at (", value,
            "(allowed: within 50 m of the base frame's origin, radius up to 10 m; a URDF is in metres)"};
        checkRefusal({"plan", (stage / "scene.yaml").string(), "--source", (stage / "rec").string()}, parts);
        checkRefused(stage, parts);
    }
}

TEST_CASE("A tool's file with several links needs tool.link, which the message lists") {
    const Stage stage;
    stage.recording({bumpImage()});
    stage.write("two.yml",
                "collision_spheres:\n  hand: [{center: [0, 0, 0], radius: 0.01}]\n"
                "  arm: [{center: [0, 0, 0], radius: 0.02}, {center: [0, 0, 0.1], radius: 0.02}]\n");
    SceneText scene;
    scene.tool = "file: two.yml";
    stage.scene(scene);
    checkRefused(stage, {"two.yml: link: not named (allowed: hand, arm"});
    scene.tool = "file: two.yml, link: hnad";
    stage.scene(scene);
    checkRefused(stage, {"two.yml: link: 'hnad' (allowed: hand, arm"});
    scene.tool = "file: two.yml, link: arm";
    stage.scene(scene);
    const ProgramRun run =
        runFathom({"plan", (stage / "scene.yaml").string(), "--source", (stage / "rec").string()});
    CHECK(run.exitCode == 0);
    CHECK(run.out.find("tool    2 leaves") != std::string::npos);
}
