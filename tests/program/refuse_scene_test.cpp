// SPDX-License-Identifier: Apache-2.0
// Invalid scene files: exit code 2 and one line with file, field, value and what is allowed.
#include "tests/rig/program_refusal.h"

#include <doctest/doctest.h>
#include <functional>

using namespace fathom;

namespace {

struct Wrong {
    std::function<void(SceneText&)> make;
    std::vector<std::string> parts; // parts of the message, besides the scene file
};

void checkScenes(const std::vector<Wrong>& cases) {
    Stage stage;
    stage.recording({bumpImage()});
    stage.hand({{0.0, {0.0, 0.0, 0.4}}});
    for (const Wrong& wrong : cases) {
        SceneText scene;
        wrong.make(scene);
        stage.scene(scene);
        std::vector<std::string> parts = wrong.parts;
        parts.push_back("scene.yaml: ");
        parts.push_back("(allowed: ");
        INFO(scene.text());
        checkRefused(stage, parts);
    }
}

void replaceFixture(SceneText& scene, const std::string& from, const std::string& to) {
    std::string& row = scene.fixtures[0];
    const size_t at = row.find(from);
    REQUIRE(at != std::string::npos);
    row.replace(at, from.size(), to);
}

Wrong haptics(const std::string& text, const std::vector<std::string>& parts) {
    return {[=](SceneText& scene) { scene.haptics = text; }, parts};
}

} // namespace

// tests/scene/refuse_test.cpp has all values; here is one of each section, and what the program itself
// checks.
TEST_CASE("A wrong value in any section ends the program with one line that names it and what is allowed") {
    checkScenes({
        {[](SceneText& s) { s.more = "camrea: {near: 1}\n"; }, {"camrea", "did you mean 'camera'"}},
        {[](SceneText& s) { s.camera = "near: 3, far: 1"; }, {"camera.near", "3", "below camera.far = 1"}},
        {[](SceneText& s) { s.filter = "radius: 2.5"; }, {"filter.radius", "2.5", "whole number"}},
        {[](SceneText& s) { replaceFixture(s, "[345, 20]", "[345, 380]"); },
         {"fixtures[0].hue[1]", "380", "0 to 360"}},
        {[](SceneText& s) { s.contact = "delay: -1"; }, {"contact.delay", "-1", "0 to 1000"}},
        {[](SceneText& s) { s.hand = "map: {scale: 0}"; }, {"hand.map.scale", "0", "from 0.001 to 100"}},
        {[](SceneText& s) { s.tool = ""; }, {"tool", "missing"}},
        {[](SceneText& s) { s.tool = "file: absent.sph"; }, {"tool.file", "absent.sph", ".sph"}},
        haptics("device: w5x", {"haptics.device", "w5x", "ideal, w5d, falcon"}),
        haptics("damping: 5", {"haptics.damping", "5", "below 0.5 N s/m", "unless stiffness is a number"}),
        {[](SceneText& s) { s.more = "pilots: [{name: ada, damping: 6}]\n"; },
         {"pilots: ada.damping", "6", "below 0.5 N s/m"}},
    });
}

TEST_CASE("A broken tool file is rejected with its own name") {
    Stage stage;
    stage.recording({bumpImage()});
    SceneText scene;
    scene.tool = "file: broken.sph";
    stage.scene(scene);
    stage.write("broken.sph", "2 2\n0 0 0 1\n0 0 zero 1\n0 0 0 1\n");
    checkRefused(stage, {"broken.sph", "zero", "allowed: "});
    stage.write("broken.sph", "");
    checkRefused(stage, {"broken.sph", "allowed: "});
}

TEST_CASE("plan rejects an invalid scene with the same line as replay") {
    Stage stage;
    stage.recording({bumpImage()});
    SceneText scene;
    scene.haptics = "device: w5x";
    stage.scene(scene);
    const std::string file = (stage / "scene.yaml").string();
    checkRefusal({"plan", file, "--source", (stage / "rec").string()},
                 {"scene.yaml", "haptics.device", "w5x", "ideal"});
    checkRefusal({"plan", file + "x"}, {"scene.yamlx", "file", "no such file"});
}

TEST_CASE("A scene file that is missing, a folder, empty, not YAML or without fixtures is rejected") {
    Stage stage;
    std::filesystem::remove(stage / "scene.yaml");
    checkRefused(stage, {"scene.yaml", "file", "no such file", "allowed: "});
    std::filesystem::create_directories(stage / "scene.yaml");
    checkRefused(stage, {"scene.yaml", "none", "a folder that the window recorded"});
    std::filesystem::remove(stage / "scene.yaml");
    stage.write("scene.yaml", "");
    checkRefused(stage, {"scene.yaml", "nothing", "mapping"});
    stage.write("scene.yaml", "camera: [1, 2\nfixtures: }");
    checkRefused(stage, {"scene.yaml", "line ", "YAML"});
    stage.write("scene.yaml", "tool: {spheres: [[0, 0, 0, 0.01]]}\n");
    checkRefused(stage, {"scene.yaml", "fixtures", "missing"});
    stage.write("scene.yaml",
                "tool: {spheres: [[0,0,0,0.01]]}\nfixtures: []\ncamera: {source: {simulated: tnak}}\n");
    checkRefused(stage, {"camera.source.simulated", "tnak", "did you mean 'tank'"});
}
