// SPDX-License-Identifier: Apache-2.0
// Analytic scenes: lists of solids whose surfaces are known exactly, which gives simulated frames a ground
// truth.
#pragma once

#include "devices/simulated/solid.h"

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace fathom {

// Scene frame: the camera's first pose (optical axes: x right, y down, z forward) [m].
struct AnalyticScene {
    std::string name;
    std::vector<Solid> solids;
    std::vector<std::string> objects; // what Solid::object names; row 0 is always "surroundings"
    bool underwater = false;          // attenuation, backscatter and marine snow apply
    glm::vec3 background{0.0f};       // linear colour where no solid is
};

// The built-in scenes, in the order that messages list them:
//   tank    panel with a red and a yellow hand-wheel valve side by side, pipes, brass; underwater
//   sphere, plane, torus, slot, gap, plate, corner   one red object, a yellow target where it does not hide
//   it, grey
//           surroundings; dry
//   wetmate  panel with a red valve and a yellow receptacle next to it; underwater
const std::vector<std::string>& analyticSceneNames();
std::optional<AnalyticScene> analyticScene(std::string_view name);

// Distance to the nearest surface of the scene [m], negative inside a solid.
double signedDistance(const AnalyticScene& scene, const dvec3& scenePoint) noexcept;

// The solid that a ray enters first: its index, and the distance along the ray [m]; solid -1 = none.
struct RayHit {
    double distance = 0.0;
    int32_t solid = -1;
};

// Linear-light colour of an sRGB one, channels 0..255.
glm::vec3 linearColour(int red, int green, int blue);

} // namespace fathom
