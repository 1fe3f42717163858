// SPDX-License-Identifier: Apache-2.0
// Invalid scene files: exit code 2 and one line with file, field, value and what is allowed.
#include "tests/rig/refusal.h"

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

Wrong fixture(const std::string& from, const std::string& to, const std::vector<std::string>& parts) {
    return {[=](SceneText& scene) { replaceFixture(scene, from, to); }, parts};
}

Wrong camera(const std::string& text, const std::vector<std::string>& parts) {
    return {[=](SceneText& scene) { scene.camera = text; }, parts};
}

Wrong haptics(const std::string& text, const std::vector<std::string>& parts) {
    return {[=](SceneText& scene) { scene.haptics = text; }, parts};
}

Wrong tool(const std::string& text, const std::vector<std::string>& parts) {
    return {[=](SceneText& scene) { scene.tool = text; }, parts};
}

} // namespace

TEST_CASE("An unknown key is rejected in every section, with the nearest known key") {
    checkScenes({
        {[](SceneText& s) { s.more = "camrea: {near: 1}\n"; }, {"camrea", "did you mean 'camera'"}},
        camera("neer: 0.2", {"camera.neer", "did you mean 'near'"}),
        {[](SceneText& s) { s.filter = "radus: 2"; }, {"filter.radus", "did you mean 'radius'", "sigma"}},
        fixture("hue:", "huge:", {"fixtures[0].huge", "did you mean 'hue'"}),
        tool("sphere: [[0, 0, 0, 0.01]]", {"tool.sphere", "did you mean 'spheres'"}),
        haptics("rate: 1000", {"haptics.rate", "did you mean 'rate_hz'"}),
        {[](SceneText& s) { s.contact = "delai: 1"; }, {"contact.delai", "did you mean 'delay'"}},
        {[](SceneText& s) { s.hand = "map: {scael: 1}"; }, {"hand.map.scael", "did you mean 'scale'"}},
    });
}

TEST_CASE(
    "A hue, saturation or radius that is out of range or not a number is rejected with its value and range") {
    checkScenes({
        fixture("[345, 20]", "[345, 380]", {"fixtures[0].hue[1]", "380", "0 to 360"}),
        fixture("[345, 20]", "[-5, 20]", {"fixtures[0].hue[0]", "-5", "0 to 360"}),
        fixture("[345, 20]", "[345]", {"fixtures[0].hue", "[345]", "list of 2"}),
        fixture("[0.4, 1]", "[0.4, 1.5]", {"fixtures[0].saturation[1]", "1.5", "0 to 1"}),
        fixture("[0.4, 1]", "[0.9, 0.2]", {"fixtures[0].saturation", "[0.9, 0.2]", "lo <= hi"}),
        fixture("0.04", "-0.04", {"fixtures[0].radius", "-0.04", "from 0.0001 to 10"}),
        fixture("0.04", "0", {"fixtures[0].radius: 0", "from 0.0001 to 10"}),
        fixture("0.04", ".nan", {"fixtures[0].radius", ".nan", "from 0.0001 to 10"}),
        fixture("0.04", "nan", {"fixtures[0].radius", "nan", "from 0.0001 to 10"}),
        fixture("0.04", ".inf", {"fixtures[0].radius", ".inf"}),
        fixture("0.04", "4 cm", {"fixtures[0].radius", "4 cm", "a number"}),
        fixture("forbidden", "forbiden",
                {"fixtures[0].role", "forbiden", "did you mean 'forbidden'", "guidance"}),
        fixture("forbidden", "keep_in", {"fixtures[0].role", "keep_in", "needs a shape"}),
    });
}

TEST_CASE("An empty depth range, an impossible filter and invalid numbers are rejected") {
    checkScenes({
        camera("near: 3, far: 1", {"camera.near", "3", "below camera.far = 1"}),
        camera("near: 5", {"camera.near", "5", "below camera.far = 3"}),
        camera("far: 0.05", {"camera.far", "0.05", "above camera.near = 0.1"}),
        camera("near: 0", {"camera.near", "0", "from 0.001 to 10000"}),
        camera("near: .nan", {"camera.near", ".nan"}),
        camera("registration_sigma: -1", {"camera.registration_sigma", "-1", "from 0 to 1"}),
        camera("base_T_camera: {xyz: [0, .nan, 0]}",
               {"camera.base_T_camera.xyz[1]", ".nan", "from -1e+06 to 1e+06"}),
        camera("base_T_camera: {quat_xyzw: [0, 0, 0, 0]}",
               {"camera.base_T_camera.quat_xyzw", "[0, 0, 0, 0]"}),
        {[](SceneText& s) { s.filter = "radius: 17"; }, {"filter.radius", "17", "0 to 16"}},
        {[](SceneText& s) { s.filter = "radius: -1"; }, {"filter.radius", "-1", "0 to 16"}},
        {[](SceneText& s) { s.filter = "radius: 2.5"; }, {"filter.radius", "2.5", "whole number"}},
        {[](SceneText& s) { s.filter = "sigma: 0"; }, {"filter.sigma", "from 1e-05 to 10"}},
        {[](SceneText& s) { s.more = "error_budget: -0.1\n"; },
         {"error_budget", "-0.1", "from 1e-07 to 0.1"}},
        {[](SceneText& s) { s.more = "hold_s: .nan\n"; }, {"hold_s", ".nan"}},
    });
}

TEST_CASE("A missing tool, a tool without spheres and a missing or broken tool file are rejected") {
    checkScenes({
        tool("", {"tool", "missing"}),
        tool("spheres: []", {"tool.spheres", "0 spheres", "1 to 4096"}),
        tool("spheres: [[0, 0, 0, -0.01]]", {"tool.spheres[0][3]", "-0.01", "from 1e-05 to 10"}),
        tool("spheres: [[0, 0, 0]]", {"tool.spheres[0]", "[0, 0, 0]", "4 numbers"}),
        tool("file: absent.sph", {"tool.file", "absent.sph", ".sph"}),
        tool("file: absent.sph, spheres: [[0, 0, 0, 1]]", {"tool", "exactly one"}),
    });
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

TEST_CASE("An unknown device preset, an impossible rate and other impossible haptics are rejected") {
    checkScenes({
        haptics("device: w5x", {"haptics.device", "w5x", "ideal, w5d, falcon"}),
        haptics("rate_hz: 50", {"haptics.rate_hz", "50", "100 to 10000"}),
        haptics("rate_hz: .nan", {"haptics.rate_hz", ".nan"}),
        haptics("stiffness: -5", {"haptics.stiffness", "-5", "auto or", "from 0.001 to 1e+06"}),
        haptics("damping: 5", {"haptics.damping", "5", "below 0.5 N s/m", "unless stiffness is a number"}),
        {[](SceneText& s) { s.more = "pilots: [{name: ada, damping: 6}]\n"; },
         {"pilots: ada.damping", "6", "below 0.5 N s/m"}},
        haptics("solves: 0", {"haptics.solves", "0", "1 to 16"}),
        haptics("guidance: magnet", {"haptics.guidance", "magnet", "target, paper"}),
        haptics("limits: {force: -1}", {"haptics.limits.force", "-1", "from 0 to 10000"}),
        {[](SceneText& s) { s.contact = "reach: 0"; }, {"contact.reach", "0"}},
        {[](SceneText& s) { s.contact = "delay: -1"; }, {"contact.delay", "-1", "0 to 1000"}},
        {[](SceneText& s) { s.hand = "map: {scale: 0}"; }, {"hand.map.scale", "0", "from 0.001 to 100"}},
        {[](SceneText& s) { s.hand = "path: somewhere"; },
         {"hand.path", "somewhere", "approach or a .csv file"}},
    });
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
