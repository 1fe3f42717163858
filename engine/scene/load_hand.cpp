// SPDX-License-Identifier: Apache-2.0
// Sections `tool` and `hand` of a scene file.
#include "engine/scene/load.h"

#include "engine/types/haptic_device.h"
#include "engine/types/sphere_tree.h"

namespace fathom {

namespace {

const Range kPlace{-kMaxToolReach, kMaxToolReach}, kRadius{kMinLeafRadius, kMaxLeafRadius};

std::vector<std::array<double, 4>> loadSpheres(const YamlNode& node) {
    const std::vector<YamlNode> rows = node.list();
    if (rows.empty() || rows.size() > kMaxLeaves) {
        node.refuse(std::to_string(rows.size()) + " spheres", "1 to " + std::to_string(kMaxLeaves));
    }
    std::vector<std::array<double, 4>> spheres;
    for (const YamlNode& row : rows) {
        const std::vector<YamlNode> numbers = row.list(4);
        spheres.push_back({numbers[0].number(kPlace), numbers[1].number(kPlace), numbers[2].number(kPlace),
                           numbers[3].number(kRadius)});
    }
    return spheres;
}

void loadHandMap(const YamlNode& map, Scene::Hand& hand) {
    map.checkKeys({"base_R_device", "scale", "clutch"});
    map.read("base_R_device", hand.baseRdevice);
    map.read("scale", hand.scale, Range::between(1e-3, 100.0));
    if (const auto clutch = map.find("clutch")) {
        hand.clutchBit = loadButtonBit(*clutch);
    }
}

void loadHandLoop(const YamlNode& node, HandLoop& loop) {
    node.checkKeys({"mass", "damping", "stiffness"});
    node.read("mass", loop.mass, Range::between(1e-3, 100.0));
    node.read("damping", loop.damping, Range::between(0.0, 1e4));
    node.read("stiffness", loop.stiffness, Range::between(0.0, 1e6));
}

} // namespace

uint32_t loadButtonBit(const YamlNode& node) {
    const uint32_t bit = node.integer(0, 1u << 31);
    if (bit == kGuidanceButton || bit == kDeadManOpen || (bit & (bit - 1)) != 0) {
        node.refuse("0 (none) or one bit of the buttons: 4, 8, 16, ...");
    }
    return bit;
}

void loadTool(const YamlNode& tool, Scene& scene) {
    tool.checkKeys({"spheres", "file", "link"});
    const auto spheres = tool.find("spheres"), file = tool.find("file");
    if (spheres.has_value() == file.has_value()) {
        tool.refuse(spheres ? "spheres and file" : "neither spheres nor file",
                    "exactly one of spheres, file");
    }
    if (const auto link = tool.find("link")) {
        scene.tool.link = link->text();
        if (!file) {
            link->refuse("none; it goes with file");
        }
    }
    if (spheres) {
        scene.tool.spheres = loadSpheres(*spheres);
        return;
    }
    scene.tool.file = besideScene(scene, file->text());
    std::error_code ignored;
    if (!std::filesystem::is_regular_file(scene.tool.file, ignored)) {
        file->refuse(scene.tool.file.string(), "an existing .sph, .urdf, .yaml, .yml, .xrdf or .json file");
    }
}

void loadHand(const YamlNode& hand, Scene& scene) {
    hand.checkKeys({"path", "map", "loop", "yields"});
    if (const auto path = hand.find("path")) {
        const std::string text = path->text();
        scene.hand.builtIn = text == "approach";
        if (!scene.hand.builtIn && !text.ends_with(".csv")) {
            path->refuse("approach or a .csv file");
        }
        scene.hand.path = scene.hand.builtIn ? text : besideScene(scene, text).string();
    }
    if (const auto map = hand.find("map")) {
        loadHandMap(*map, scene.hand);
    }
    if (const auto loop = hand.find("loop")) {
        loadHandLoop(*loop, scene.hand.loop);
    }
    hand.read("yields", scene.hand.yields);
}

} // namespace fathom
