// SPDX-License-Identifier: Apache-2.0
// Section `arm` of a scene file.
#include "engine/scene/load.h"

#include <algorithm>

namespace fathom {

namespace {

const Range kJoint = Range::between(-1e4, 1e4); // [rad], [m]

std::string nameOnce(const YamlNode& node, const std::vector<std::string>& before) {
    const std::string name = node.text();
    if (std::find(before.begin(), before.end(), name) != before.end()) {
        node.refuse("'" + name + "' again", "each joint once");
    }
    return name;
}

void loadJoints(const YamlNode& list, SceneArm& arm) {
    std::vector<std::string> names;
    for (const YamlNode& row : list.list()) {
        row.checkKeys({"name", "lower", "upper", "speed", "start"});
        SceneArm::Joint joint;
        names.push_back(joint.name = nameOnce(row.at("name"), names));
        row.read("lower", joint.lower, kJoint);
        row.read("upper", joint.upper, kJoint);
        row.read("speed", joint.speed, Range::between(1e-6, 1e3));
        row.read("start", joint.start, kJoint);
        if (joint.lower && joint.upper && *joint.lower > *joint.upper) {
            row.refuse("lower " + row.at("lower").value() + ", upper " + row.at("upper").value(),
                       "lower <= upper");
        }
        arm.joints.push_back(joint);
    }
}

void loadGrasp(const YamlNode& node, SceneArm& arm, uint32_t clutchBit) {
    node.checkKeys({"fingers", "button", "seconds"});
    std::vector<std::string> names;
    for (const YamlNode& row : node.at("fingers").list()) {
        row.checkKeys({"joint", "open", "closed"});
        SceneArm::Finger finger;
        names.push_back(finger.joint = nameOnce(row.at("joint"), names));
        row.read("open", finger.open, kJoint);
        row.read("closed", finger.closed, kJoint);
        arm.grasp.fingers.push_back(finger);
    }
    if (const auto button = node.find("button")) {
        arm.grasp.button = loadButtonBit(*button);
    }
    if (arm.grasp.button != 0 && arm.grasp.button == clutchBit) {
        node.refuse("button " + std::to_string(clutchBit), "another bit than hand.map.clutch");
    }
    node.read("seconds", arm.grasp.seconds, Range::between(0.05, 60.0));
}

std::filesystem::path existing(const YamlNode& node, Scene& scene, bool folder) {
    const std::filesystem::path path = besideScene(scene, node.text());
    std::error_code ignored;
    if (folder ? !std::filesystem::is_directory(path, ignored)
               : !std::filesystem::is_regular_file(path, ignored)) {
        node.refuse(path.string(), folder ? "an existing folder" : "an existing URDF file");
    }
    return path;
}

} // namespace

void loadArmSection(const YamlNode& node, Scene& scene) {
    node.checkKeys({"urdf", "meshes", "base_T_arm", "base", "tip", "leaves", "joints", "locked", "keep_stray",
                    "direction", "self_filter", "grasp", "driver"});
    SceneArm arm;
    arm.urdf = existing(node.at("urdf"), scene, false);
    if (const auto meshes = node.find("meshes")) {
        arm.meshes = existing(*meshes, scene, true);
    }
    if (const auto pose = node.find("base_T_arm")) {
        arm.baseTarm = loadPose(*pose);
    }
    node.read("base", arm.base);
    node.read("tip", arm.tip);
    node.read("leaves", arm.leaves, 1, 2048);
    if (const auto joints = node.find("joints")) {
        loadJoints(*joints, arm);
    }
    if (const auto locked = node.find("locked")) {
        for (const auto& [name, value] : locked->entries()) {
            arm.locked[name] = value.number(Range::finite());
        }
    }
    node.read("keep_stray", arm.keepStray);
    node.read("direction", arm.freeDirection, {{"follow", false}, {"free", true}});
    node.read("self_filter", arm.selfFilter, Range::between(0.0, 0.5));
    if (const auto grasp = node.find("grasp")) {
        loadGrasp(*grasp, arm, scene.hand.clutchBit);
    }
    if (const auto driver = node.find("driver")) {
        arm.driver = loadArmDriver(*driver);
    }
    scene.arm = std::move(arm);
}

} // namespace fathom
