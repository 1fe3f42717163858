// SPDX-License-Identifier: Apache-2.0
// The sections of a scene file, one function each. Every one throws BadInput at the first value that is not
// allowed.
#pragma once

#include "engine/scene/scene.h"
#include "engine/scene/yaml_node.h"

namespace fathom {

// Each reads the section of that name into its part of the scene. Any thread; no state.
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

// Stiffness and limits: what a pilot may have otherwise. The caller has checked the keys.
void loadFeel(const YamlNode& node, Scene::Haptics& haptics);

// {xyz, quat_xyzw}, each optional.
Pose loadPose(const YamlNode& node);

// 0 or one bit of the hand's buttons that nothing else has (1 guidance, 2 dead-man open).
uint32_t loadButtonBit(const YamlNode& node);

// As given when absolute, else taken from the scene file's folder. Notes a path that leads out of it, by its
// words or by a link, in Scene::outside.
std::filesystem::path besideScene(Scene& scene, const std::string& path);

} // namespace fathom
