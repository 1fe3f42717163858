// SPDX-License-Identifier: Apache-2.0
// The sections of a scene file, one function each. Each throws BadInput at the first invalid value.
#pragma once

#include "engine/scene/scene.h"
#include "engine/scene/yaml_node.h"
#include "engine/types/sphere_tree.h"

namespace fathom {

// Each function reads the section of its name into the scene. Any thread; no state.
void loadCamera(const YamlNode& camera, Scene& scene);
void loadFilter(const YamlNode& filter, Scene& scene);
void loadFixtures(const YamlNode& fixtures, Scene& scene);
void loadTool(const YamlNode& tool, Scene& scene);
void loadArmSection(const YamlNode& arm, Scene& scene);
SceneArm::Driver loadArmDriver(const YamlNode& driver);
void loadHand(const YamlNode& hand, Scene& scene);
void loadHaptics(const YamlNode& haptics, Scene& scene);
void loadPilots(const YamlNode& pilots, Scene& scene); // after hand and haptics
void loadWindow(const YamlNode& window, Scene& scene);
void loadContact(const YamlNode& contact, Scene& scene);

// Stiffness and limits, which a pilot may override. The caller has checked the keys.
void loadFeel(const YamlNode& node, Scene::Haptics& haptics);

// {xyz, quat_xyzw}, each optional.
Pose loadPose(const YamlNode& node);

// 0 or one button bit that is not in use (haptic_device.h).
uint32_t loadButtonBit(const YamlNode& node);

// Absolute paths as given, others relative to the scene file's folder. A path that leaves that folder, by
// `..` or by a link, is added to Scene::outside.
std::filesystem::path besideScene(Scene& scene, const std::string& path);

} // namespace fathom
