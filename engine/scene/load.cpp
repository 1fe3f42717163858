// SPDX-License-Identifier: Apache-2.0
#include "engine/scene/load.h"

#include "engine/types/inside.h"

namespace fathom {

Pose loadPose(const YamlNode& node) {
    node.checkKeys({"xyz", "quat_xyzw"});
    Pose pose;
    node.read("xyz", pose.position, Range::position());
    node.read("quat_xyzw", pose.rotation);
    return pose;
}

std::filesystem::path besideScene(Scene& scene, const std::string& path) {
    const std::filesystem::path folder = scene.file.parent_path();
    std::filesystem::path file = (folder / path).lexically_normal();
    if (!staysInside(path) || !liesInside(file, folder)) {
        scene.outside.push_back(path);
    }
    return file;
}

namespace {

// What turns images into points.
void loadImageSections(const YamlNode& root, Scene& scene) {
    if (const auto camera = root.find("camera")) {
        loadCamera(*camera, scene);
    }
    if (const auto filter = root.find("filter")) {
        loadFilter(*filter, scene);
    }
    root.read("error_budget", scene.errorBudget, Range::zeroOr(1e-7, 0.1));
    root.read("hold_s", scene.holdSeconds, Range::between(0.0, 3600.0));
}

void choosePilot(const YamlNode& pilot, Scene& scene) {
    if (!scene.choosePilot(pilot.text())) {
        pilot.refuse(scene.pilots.empty() ? "none: the file has no pilots" : scene.pilotNames());
    }
}

Scene sceneOf(const YamlNode& root, const std::filesystem::path& file) {
    root.checkKeys({"camera", "filter", "error_budget", "hold_s", "fixtures", "tool", "arm", "hand",
                    "haptics", "contact", "pilots", "pilot", "window"});
    Scene scene;
    scene.file = file;
    loadImageSections(root, scene);
    loadFixtures(root.at("fixtures"), scene);
    const auto arm = root.find("arm"), tool = root.find("tool");
    if (tool || !arm) { // an arm needs no extra tool
        loadTool(root.at("tool"), scene);
    }
    if (const auto hand = root.find("hand")) {
        loadHand(*hand, scene);
    }
    if (scene.source.showsArm && !arm) {
        root.at("camera").at("source").at("arm").refuse("false without a section arm");
    }
    if (arm) {
        loadArmSection(*arm, scene);
    }
    if (const auto haptics = root.find("haptics")) {
        loadHaptics(*haptics, scene);
    }
    if (const auto contact = root.find("contact")) {
        loadContact(*contact, scene);
    }
    if (const auto pilots = root.find("pilots")) {
        loadPilots(*pilots, scene);
    }
    if (const auto pilot = root.find("pilot")) {
        choosePilot(*pilot, scene);
    }
    if (const auto window = root.find("window")) {
        loadWindow(*window, scene);
    }
    return scene;
}

} // namespace

Scene loadScene(const std::filesystem::path& file) {
    return sceneOf(YamlNode::parseFile(file), file);
}

Scene loadSceneText(const std::string& text, const std::string& name) {
    return sceneOf(YamlNode::parseText(name, text), name);
}

} // namespace fathom
