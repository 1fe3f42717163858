// SPDX-License-Identifier: Apache-2.0
// Section `arm` of a scene file.
#include "engine/scene/load.h"

#include <algorithm>

namespace fathom {

namespace {

const Range kJoint = Range::between(-1e4, 1e4); // [rad], [m]

std::optional<double> loadOptional(const YamlNode& node, std::string_view key, const Range& range) {
    const auto value = node.find(key);
    return value ? std::optional(value->number(range)) : std::nullopt;
}

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
        joint.lower = loadOptional(row, "lower", kJoint);
        joint.upper = loadOptional(row, "upper", kJoint);
        joint.speed = loadOptional(row, "speed", Range::between(1e-6, 1e3));
        joint.start = loadOptional(row, "start", kJoint);
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
        finger.open = loadOptional(row, "open", kJoint);
        finger.closed = loadOptional(row, "closed", kJoint);
        arm.grasp.fingers.push_back(finger);
    }
    if (const auto button = node.find("button")) {
        arm.grasp.button = loadButtonBit(*button);
    }
    if (arm.grasp.button != 0 && arm.grasp.button == clutchBit) {
        node.refuse("button " + std::to_string(clutchBit), "another bit than hand.map.clutch");
    }
    if (const auto seconds = node.find("seconds")) {
        arm.grasp.seconds = seconds->number(Range::between(0.05, 60.0));
    }
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
    if (const auto base = node.find("base")) {
        arm.base = base->text();
    }
    if (const auto tip = node.find("tip")) {
        arm.tip = tip->text();
    }
    if (const auto leaves = node.find("leaves")) {
        arm.leaves = leaves->integer(1, 2048);
    }
    if (const auto joints = node.find("joints")) {
        loadJoints(*joints, arm);
    }
    if (const auto locked = node.find("locked")) {
        for (const auto& [name, value] : locked->entries()) {
            arm.locked[name] = value.number(Range::finite());
        }
    }
    if (const auto stray = node.find("keep_stray")) {
        arm.keepStray = stray->boolean();
    }
    if (const auto direction = node.find("direction")) {
        arm.freeDirection = direction->choice<bool>({{"follow", false}, {"free", true}});
    }
    arm.selfFilter = loadOptional(node, "self_filter", Range::between(0.0, 0.5));
    if (const auto grasp = node.find("grasp")) {
        loadGrasp(*grasp, arm, scene.hand.clutchBit);
    }
    if (const auto driver = node.find("driver")) {
        arm.driver = loadArmDriver(*driver);
    }
    scene.arm = std::move(arm);
}

} // namespace fathom
