// SPDX-License-Identifier: Apache-2.0
// Invalid scene files. The message names file, field, value and what is allowed.
#include "engine/types/suggestion.h"
#include "tests/scene/scene_file.h"
#include "tests/support/refusal.h"

#include <doctest/doctest.h>

using namespace fathom;

namespace {

// One invalid value: the text, the expected message after the file name ("field: value"), and what is
// allowed.
struct Bad {
    std::string text, fieldAndValue, allowed;
};

void checkRefused(const std::vector<Bad>& all) {
    for (const Bad& bad : all) {
        const std::string message = refusal(bad.text);
        CAPTURE(bad.text);
        CAPTURE(message);
        CHECK(message.find("scene.yaml: " + bad.fieldAndValue) != std::string::npos);
        const size_t allowed = message.find("(allowed: ");
        REQUIRE(allowed != std::string::npos);
        CHECK(message.find(bad.allowed, allowed) != std::string::npos);
        CHECK(message.find('\n') == std::string::npos); // one line
    }
}

Bad fixture(const std::string& values, const std::string& fieldAndValue, const std::string& allowed) {
    return {"fixtures: [{name: a, role: forbidden, " + values + "}]\n" + kTool,
            "fixtures[0]." + fieldAndValue, allowed};
}

Bad section(const std::string& text, const std::string& fieldAndValue, const std::string& allowed) {
    return {kMinimal + text + "\n", fieldAndValue, allowed};
}

std::string pointRows(size_t count) {
    std::string text = "fixtures:\n";
    for (size_t i = 0; i < count; ++i) {
        text += " - {name: n" + std::to_string(i) + ", role: forbidden}\n";
    }
    return text + kTool;
}

} // namespace

TEST_CASE("Unknown keys are rejected at every level with the nearest known key") {
    checkRefused({
        section("camera: {<<: {near: 1}}", "camera.<<: a merge key", "keys written out: "),
        section("camra: {}", "camra: unknown key, did you mean 'camera'?", "fixtures"),
        section("camera: {nera: 1}", "camera.nera: unknown key, did you mean 'near'?", "near"),
        section("camera: {source: {recoded: x}}",
                "camera.source.recoded: unknown key, did you mean 'recorded'?", "v4l2"),
        section("camera: {base_T_camera: {quat: [0,0,0,1]}}", "camera.base_T_camera.quat: unknown key",
                "quat_xyzw"),
        section("filter: {sgima: 1}", "filter.sgima: unknown key, did you mean 'sigma'?", "sigma"),
        fixture("heu: [0, 1]", "heu: unknown key, did you mean 'hue'?", "hue"),
        fixture("colour: red", "colour: unknown key (allowed: name, role", "hue"),
        fixture("box: {min: [0,0,0], mx: [1,1,1]}", "box.mx: unknown key, did you mean 'max'?", "max"),
        section("hand: {pth: approach}", "hand.pth: unknown key, did you mean 'path'?", "path"),
        section("hand: {map: {scal: 1}}", "hand.map.scal: unknown key, did you mean 'scale'?", "scale"),
        section("hand: {loop: {mas: 1}}", "hand.loop.mas: unknown key, did you mean 'mass'?", "mass"),
        section("haptics: {rate: 1000}", "haptics.rate: unknown key, did you mean 'rate_hz'?", "rate_hz"),
        section("haptics: {limits: {slew_N_s: 1}}",
                "haptics.limits.slew_N_s: unknown key, did you mean 'slew_N_per_s'?", ""),
        section("contact: {raech: 1}", "contact.raech: unknown key, did you mean 'reach'?", "reach"),
        {"fixtures: []\ntool: {sphere: []}\n", "tool.sphere: unknown key, did you mean 'spheres'?", "file"},
        section("contact: {delay: 0, delay: 1}", "contact.delay: given twice", "once"),
        section("contact: {? [a, b] : 1}", "contact, line 3: a key that is not a word", "delay"),
    });
}

TEST_CASE("A suggestion counts a swap of neighbours as one error, and a word unlike all gets none") {
    constexpr std::array<std::string_view, 3> kWords{"frocks", "force", "near"};
    CHECK(suggestion("froce", kWords) == ", did you mean 'force'?"); // "frocks", two letters away, is first
    CHECK(suggestion("fear", kWords) == ", did you mean 'near'?");
    CHECK(suggestion("ocean", kWords).empty());
    CHECK(suggestion("", kWords).empty());
    CHECK(suggestion(std::string(100000, 'k'), kWords).empty());
}

TEST_CASE("Colour gates outside their range, reversed or of another form are rejected") {
    checkRefused({
        fixture("hue: [-1, 20]", "hue[0]: -1", "from 0 to 360"),
        fixture("hue: [0, 360.5]", "hue[1]: 360.5", "from 0 to 360"),
        fixture("hue: [10]", "hue: [10]", "2 numbers"),
        fixture("hue: red", "hue: red", "2 numbers"),
        fixture("hue: [.nan, 20]", "hue[0]: .nan", "from 0 to 360"),
        fixture("saturation: [0, 1.01]", "saturation[1]: 1.01", "from 0 to 1"),
        fixture("saturation: [0.9, 0.1]", "saturation: [0.9, 0.1]", "lo <= hi"),
        fixture("lightness: [-0.1, 1]", "lightness[0]: -0.1", "from 0 to 1"),
        fixture("lightness: [0.5, 0.4]", "lightness: [0.5, 0.4]", "lo <= hi"),
        fixture("intensity: [-0.1, 1]", "intensity[0]: -0.1", "from 0 to 1"),
        fixture("lightness: [0, 1], intensity: [0, 1]", "intensity: [0, 1]", "instead of lightness"),
    });
}

TEST_CASE("Points with a bad radius, box or guidance value are rejected") {
    checkRefused({
        fixture("radius: -0.01", "radius: -0.01", "from 0.0001 to 10"),
        fixture("radius: 0", "radius: 0", "from 0.0001 to 10"),
        fixture("radius: .nan", "radius: .nan", "from 0.0001 to 10"),
        fixture("radius: nan", "radius: nan", "from 0.0001 to 10"),
        fixture("radius: .inf", "radius: .inf", "from 0.0001 to 10"),
        fixture("radius: 1e999", "radius: 1e999", "from 0.0001 to 10"),
        fixture("radius: \"0.04\"", "radius: '0.04' in quotes", "from 0.0001 to 10"),
        fixture("radius: 4cm", "radius: 4cm", "from 0.0001 to 10"),
        fixture("radius:", "radius: nothing", "from 0.0001 to 10"),
        fixture("box: {min: [0,0,2], max: [1,1,1]}", "box: min [0, 0, 2], max [1, 1, 1]", "min <= max"),
        fixture("box: {min: [0,0,0]}", "box.max: missing", "must be given"),
        fixture("box: {min: [0,0,.inf], max: [1,1,1]}", "box.min[2]: .inf", "from -1e+09 to 1e+09"),
        fixture("box: {min: [0,0], max: [1,1,1]}", "box.min: [0, 0]", "3 numbers"),
        fixture("quat_xyzw: [0, 0, 0, 0]", "quat_xyzw: [0, 0, 0, 0]", "non-zero length"),
        fixture("quat_xyzw: [0, 0, 1]", "quat_xyzw: [0, 0, 1]", "4 numbers"),
        fixture("min_count: 0", "min_count: 0", "from 1"),
        fixture("min_count: 2.5", "min_count: 2.5", "whole number"),
        fixture("trim: 0.6", "trim: 0.6", "from 0 to 0.5"),
        fixture("largest_part: yes please", "largest_part: yes please", "true or false"),
        fixture("standoff: near", "standoff: near", "from -10 to 10"),
    });
}

TEST_CASE("Rows without a name or role, or with invalid combinations, are rejected") {
    checkRefused({
        {"fixtures: [{role: forbidden}]\n" + kTool, "fixtures[0].name: missing", "must be given"},
        {"fixtures: [{name: '', role: forbidden}]\n" + kTool, "fixtures[0].name: empty text", "text"},
        {"fixtures: [{name: a}]\n" + kTool, "fixtures[0].role: missing", "must be given"},
        {"fixtures: [{name: a, role: forbiden}]\n" + kTool,
         "fixtures[0].role: forbiden, did you mean 'forbidden'?", "keep_in"},
        {"fixtures: [{name: a, role: forbidden}, {name: a, role: guidance}]\n" + kTool, "fixtures[1].name: a",
         "by an earlier row"},
        {"fixtures: [{name: a, role: keep_in}]\n" + kTool, "fixtures[0].role: keep_in", "needs a shape"},
        {"fixtures: [{name: a, role: guidance, shape: box, size: [1,1,1]}]\n" + kTool,
         "fixtures[0].role: guidance", "keep_in"},
        {"fixtures: [3]\n" + kTool, "fixtures[0]: 3", "a mapping"},
        {"fixtures: {name: a}\n" + kTool, "fixtures: a mapping", "a list"},
        {kTool, "fixtures: missing", "must be given"},
        {"", "file: nothing", "fixtures"},
        {pointRows(9), "fixtures: 9 classes of points", "at most 8"},
        {pointRows(65), "fixtures: 65 rows", "at most 64"},
    });
    CHECK(refusal(pointRows(8)) == "");
}

TEST_CASE("Shapes without their size or with keys of points are rejected") {
    checkRefused({
        fixture("shape: cube", "shape: cube", "sphere, box, plane, cylinder, line, axis"),
        fixture("shape: box", "size: missing", "must be given"),
        fixture("shape: box, size: [1, 0, 1]", "size[1]: 0", "from 0.0001 to 10000"),
        fixture("shape: sphere, size: [0, 1, 1]", "size[0]: 0", "from 0.0001 to 10000"),
        fixture("shape: cylinder, size: [1, -1, 0]", "size[1]: -1", "from 0 to 10000"),
        fixture("shape: cylinder, size: [1, 0, 0]", "size[1]: 0", "from 0.0001 to 10000"),
        fixture("shape: plane, base_T_shape: {xyz: [0, 0, .nan]}", "base_T_shape.xyz[2]: .nan",
                "from -1e+06 to 1e+06"),
        fixture("shape: sphere, radius: 1", "radius: 1", "without a shape"),
        fixture("shape: plane, hue: [0, 1]", "hue: [0, 1]", "without a shape"),
        fixture("size: [1, 1, 1]", "size: [1, 1, 1]", "with a shape"),
    });
}

TEST_CASE("Camera and filter values outside their range are rejected") {
    checkRefused({
        section("camera: {near: 0}", "camera.near: 0", "from 0.001 to 10000"),
        section("camera: {near: -1}", "camera.near: -1", "from 0.001 to 10000"),
        section("camera: {near: 3}", "camera.near: 3", "below camera.far"),
        section("camera: {near: 2, far: 1}", "camera.near: 2", "below camera.far"),
        section("camera: {far: 0.05}", "camera.far: 0.05", "above camera.near"),
        section("camera: {source: {}}", "camera.source: 0 sources", "exactly one"),
        section("camera: {source: {simulated: tank, recorded: x}}", "camera.source: 2 sources",
                "exactly one"),
        section("camera: {source: {simulated: tnak}}", "camera.source.simulated: tnak, did you mean 'tank'?",
                "corner, sonar"),
        section("camera: {source: {simulated: tank, colour: rgb}}", "camera.source.colour: rgb",
                "rgba, yuyv"),
        section("camera: {source: {simulated: sonar, colour: yuyv}}", "camera.source.colour: yuyv",
                "rgba: the simulated sonar is grey"),
        section("camera: {source: {recorded: x, colour: yuyv}}", "camera.source.colour: yuyv",
                "only a simulated camera"),
        section("camera: {source: {recorded: ''}}", "camera.source.recorded: empty text", "text"),
        section("camera: {base_T_camera: {quat_xyzw: [0,0,0,0]}}",
                "camera.base_T_camera.quat_xyzw: [0, 0, 0, 0]", "non-zero"),
        section("camera: {base_T_camera: {xyz: [0,0,a]}}", "camera.base_T_camera.xyz[2]: a",
                "from -1e+06 to 1e+06"),
        section("camera: {registration_sigma: -1}", "camera.registration_sigma: -1", "from 0 to 1"),
        section("camera: 3", "camera: 3", "a mapping"),
        section("filter: {radius: 17}", "filter.radius: 17", "from 0 to 16"),
        section("filter: {radius: 1.5}", "filter.radius: 1.5", "whole number"),
        section("filter: {radius: -1}", "filter.radius: -1", "from 0 to 16"),
        section("filter: {sigma: 0}", "filter.sigma: 0", "from 1e-05 to 10"),
        section("filter: {edge: -0.1}", "filter.edge: -0.1", "from 0 to 10"),
        section("filter: {isolated: drop}", "filter.isolated: drop", "reject, keep"),
        section("error_budget: -1", "error_budget: -1", "0, or a number from 1e-07 to 0.1"),
        section("hold_s: forever", "hold_s: forever", "from 0 to 3600"),
    });
}

TEST_CASE("A scene without a usable tool is rejected") {
    const std::string fixtures = "fixtures: []\n";
    checkRefused({
        {fixtures, "tool: missing", "must be given"},
        {fixtures + "tool: {}\n", "tool: neither spheres nor file", "exactly one"},
        {fixtures + "tool: {spheres: [[0,0,0,1]], file: a.sph}\n", "tool: spheres and file", "exactly one"},
        {fixtures + "tool: {spheres: [[0,0,0,1]], link: hand}\n", "tool.link: hand", "with file"},
        {fixtures + "tool: {spheres: []}\n", "tool.spheres: 0 spheres", "1 to 4096"},
        {fixtures + "tool: {spheres: [[0,0,0]]}\n", "tool.spheres[0]: [0, 0, 0]", "4 numbers"},
        {fixtures + "tool: {spheres: [[0,0,0,1], [0,0,0,0]]}\n", "tool.spheres[1][3]: 0", "from 1e-05 to 10"},
        {fixtures + "tool: {spheres: [[0,.inf,0,1]]}\n", "tool.spheres[0][1]: .inf", "from -50 to 50"},
    });
    const std::string message = refusal(fixtures + "tool: {file: nowhere.sph}\n");
    CHECK(message.find("tool.file: ") != std::string::npos);
    CHECK(message.find("nowhere.sph (allowed: an existing .sph, .urdf, .yaml, .yml, .xrdf or .json file)") !=
          std::string::npos);
}

TEST_CASE("Hand, haptics and contact values outside their range are rejected") {
    checkRefused({
        section("hand: {path: wander}", "hand.path: wander", "approach or a .csv"),
        section("hand: {map: {base_R_device: [0,0,0,0]}}", "hand.map.base_R_device: [0, 0, 0, 0]",
                "non-zero"),
        section("hand: {map: {scale: 0}}", "hand.map.scale: 0", "from 0.001 to 100"),
        section("hand: {map: {clutch: 2}}", "hand.map.clutch: 2", "one bit"),
        section("hand: {map: {clutch: 12}}", "hand.map.clutch: 12", "one bit"),
        section("hand: {loop: {mass: 0}}", "hand.loop.mass: 0", "from 0.001 to 100"),
        section("hand: {loop: {damping: -1}}", "hand.loop.damping: -1", "from 0 to 10000"),
        section("haptics: {rate_hz: 99}", "haptics.rate_hz: 99", "from 100 to 10000"),
        section("haptics: {rate_hz: 10001}", "haptics.rate_hz: 10001", "from 100 to 10000"),
        section("haptics: {device: ''}", "haptics.device: empty text", "text"),
        section("haptics: {stiffness: 0}", "haptics.stiffness: 0", "auto or a number from 0.001 to 1e+06"),
        section("haptics: {rotational_stiffness: atuo}", "haptics.rotational_stiffness: atuo",
                "auto or a number from 1e-06 to 100000"),
        section("haptics: {friction: 1.1}", "haptics.friction: 1.1", "from 0 to 1"),
        section("haptics: {damping: much}", "haptics.damping: much", "auto or a number from 0 to 100"),
        section("haptics: {margin: 0}", "haptics.margin: 0", "from 0.05 to 1"),
        section("haptics: {smooth: yes}", "haptics.smooth: yes", "true or false"),
        section("haptics: {guidance: spring}", "haptics.guidance: spring", "target, paper"),
        section("haptics: {step_cap: 1e-6}", "haptics.step_cap: 1e-6", "from 1e-05 to 0.05"),
        section("haptics: {step_cap: 0.051}", "haptics.step_cap: 0.051", "from 1e-05 to 0.05"),
        section("haptics: {solves: 0}", "haptics.solves: 0", "from 1 to 16"),
        section("haptics: {solves: 17}", "haptics.solves: 17", "from 1 to 16"),
        section("haptics: {delay: 65}", "haptics.delay: 65", "from 0 to 64"),
        section("haptics: {delay: 1.5}", "haptics.delay: 1.5", "from 0 to 64"),
        section("haptics: {limits: {force: -1}}", "haptics.limits.force: -1",
                "preset or a number from 0 to 10000"),
        section("haptics: {limits: {slew_N_per_s: 0}}", "haptics.limits.slew_N_per_s: 0",
                "from 0.1 to 1e+09"),
        section("haptics: {limits: {lowpass_hz: 500}}", "haptics.limits.lowpass_hz: 500",
                "half of haptics.rate_hz"),
        section("contact: {where: npu}", "contact.where: npu", "auto, cpu, gpu"),
        section("contact: {reach: 0.00009}", "contact.reach: 0.00009", "from 0.0001 to 1"),
        section("contact: {reach: 1.1}", "contact.reach: 1.1", "from 0.0001 to 1"),
        section("contact: {delay: 1001}", "contact.delay: 1001", "from 0 to 1000"),
        section("contact: {delay: -1}", "contact.delay: -1", "from 0 to 1000"),
    });
}

TEST_CASE("An oversized scene is rejected with its size and the limit") {
    checkRefused({{kMinimal + "#" + std::string(1 << 20, 'x'),
                   "file: " + std::to_string(kMinimal.size() + 1 + (1 << 20)) + " bytes",
                   "a readable scene file (YAML) of at most 1 MiB"}});
}

TEST_CASE("A missing file, one that is not YAML and one nested too deep are rejected, with the line") {
    checkRefused({
        {kMinimal + "camera: {near: 1\n", "line ", "YAML"},
        {kMinimal + "hold_s: 1\n\tcamera: 2\n", "line 4: a tab at the beginning",
         "YAML, indented with spaces"},
        {kMinimal + "---\nhold_s: 1\n", "line 3: more than a YAML document", "one document"},
        {",", "line 1: more than a YAML document", "one document"},
        {kMinimal + "]\n", "line ", "YAML"},
        {std::string(100000, '['), "line 1: ", "YAML"},
        {"&a [*a]\n", "file: ", "a mapping"},
        {"fixtures: &a [*a]\n" + kTool, "fixtures[0]: ", "a mapping"},
        {std::string("\x00\x01\xff\xfe{", 5), "", ""},
    });
    for (const auto& [path, why] : {std::pair("no/such/scene.yaml", "no such file"),
                                    {"tests", "a folder"},
                                    {"/dev/zero", "a pipe or device"}}) {
        CHECK(testing::refusalOf([&, path = path] {
                  loadScene(path);
              }).find(std::string(path) + ": file: " + why) == 0);
    }
}

TEST_CASE("Tags that the program does not know, such as xacro's !degrees, are rejected with their line") {
    const std::string allowed = "(allowed: values without a tag; angles in rad)";
    for (const char* text : {"!degrees 90", "!radians 1.5", "!list [1]", "!table {near: 1}", "!other"}) {
        const std::string message = refusal(kMinimal + "camera:\n  near: " + text + "\n");
        CAPTURE(message);
        CHECK(message.find("scene.yaml: line 4: tag '!") != std::string::npos);
        CHECK(message.find(allowed) != std::string::npos);
    }
    CHECK(refusal(kMinimal + "camera: {near: !!float 0.2, far: !!int 3}\n").empty());
    CHECK(refusal(kMinimal + "camera: {near: !!str 0.2}\n").find("camera.near: '0.2' in quotes") !=
          std::string::npos);
}
