// SPDX-License-Identifier: Apache-2.0
#include "devices/simulated/sonar_scene.h"

#include <cmath>
#include <glm/geometric.hpp>

namespace fathom {

AnalyticScene sonarScene() {
    const Paint sand{glm::vec3(0.12f)}, steel{glm::vec3(1.0f)}, concrete{glm::vec3(0.35f)};
    AnalyticScene scene;
    scene.name = "sonar";
    scene.objects = {"surroundings", "steel", "block"};
    scene.underwater = true;
    const auto put = [&](Solid solid, uint8_t object) {
        solid.object = object;
        scene.solids.push_back(solid);
    };
    put(planeThrough({0.0, 0.50, 0.0}, {0.0, -1.0, 0.0}, sand), 0);
    put(cylinderBetween({-1.5, -0.05, 1.5}, {1.5, -0.05, 1.5}, 0.05, steel), 1);
    for (const double x : {-0.45, 0.45}) {
        put(cylinderBetween({x - 0.015, -0.05, 1.5}, {x + 0.015, -0.05, 1.5}, 0.085, steel), 1);
    }
    const dvec3 wheel(-0.15, -0.05, 1.36);
    put(torusAt(wheel, {0.0, 0.0, 1.0}, 0.09, 0.012, steel), 1);
    put(cylinderBetween(wheel, {-0.15, -0.05, 1.5}, 0.02, steel), 1);
    for (int i = 0; i < 4; ++i) {
        const double angle = 0.25 * std::acos(-1.0) * (1 + 2 * i);
        put(capsuleBetween(wheel, wheel + 0.09 * dvec3(std::cos(angle), std::sin(angle), 0.0), 0.008, steel),
            1);
    }
    put(boxAt({{0.55, 0.32, 1.6}, glm::angleAxis(0.4, dvec3(0.0, 1.0, 0.0))}, {0.16, 0.18, 0.16}, concrete),
        2);
    return scene;
}

} // namespace fathom
