// SPDX-License-Identifier: Apache-2.0
#include "devices/simulated/wetmate_scene.h"

#include "devices/simulated/paints.h"

#include <cmath>

namespace fathom {

namespace {

constexpr uint8_t kValve = 1, kReceptacle = 2;
const dvec3 kOut(0.0, 0.0, -1.0); // towards the camera

void add(AnalyticScene& scene, uint8_t object, Solid solid) {
    solid.object = object;
    scene.solids.push_back(solid);
}

// Rim, hub and four spokes on a steel stem.
void addValve(AnalyticScene& scene) {
    const dvec3 c = kWetmateWheel;
    add(scene, kValve, torusAt(c, kOut, 0.060, 0.010, paint::kRed));
    add(scene, kValve, cylinderBetween(c - 0.015 * kOut, c + 0.006 * kOut, 0.020, paint::kRed));
    for (int i = 0; i < 4; ++i) {
        const double angle = 0.3 + 0.5 * std::acos(-1.0) * i;
        const dvec3 radial(std::cos(angle), std::sin(angle), 0.0);
        add(scene, kValve, capsuleBetween(c + 0.018 * radial, c + 0.060 * radial, 0.007, paint::kRed));
    }
    add(scene, 0, cylinderBetween(c - 0.015 * kOut, c - 0.140 * kOut, 0.012, paint::kSteel));
}

// A ring face round a dark socket, on a tube from the panel.
void addReceptacle(AnalyticScene& scene) {
    const dvec3 c = kWetmateFace;
    add(scene, kReceptacle, cylinderBetween(c, c - 0.030 * kOut, 0.040, paint::kYellow));
    add(scene, 0, cylinderBetween(c + 0.001 * kOut, c - 0.010 * kOut, 0.014, paint::kBlack));
    add(scene, 0, cylinderBetween(c - 0.030 * kOut, c - 0.120 * kOut, 0.034, paint::kSteel));
}

} // namespace

AnalyticScene wetmateScene() {
    AnalyticScene scene;
    scene.name = "wetmate";
    scene.objects = {"surroundings", "valve", "receptacle"};
    scene.underwater = true;
    scene.background = glm::vec3(0.02f);
    add(scene, 0, planeThrough({0.0, 0.0, 1.60}, kOut, paint::kWall));
    add(scene, 0, boxAt({{0.02, 0.02, 1.02}, dquat(1.0, 0.0, 0.0, 0.0)}, {0.30, 0.22, 0.02}, paint::kPanel));
    addValve(scene);
    addReceptacle(scene);
    return scene;
}

} // namespace fathom
