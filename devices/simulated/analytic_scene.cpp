// SPDX-License-Identifier: Apache-2.0
#include "devices/simulated/analytic_scene.h"

#include "devices/simulated/tank_scene.h"
#include "devices/simulated/wetmate_scene.h"

#include <cmath>
#include <numbers>

namespace fathom {

namespace {

Paint redPaint() {
    return {linearColour(200, 36, 32), 0.1f, 0.0f};
}
Paint yellowPaint() {
    return {linearColour(220, 190, 40), 0.1f, 0.0f};
}
Paint greyPaint() {
    return {linearColour(128, 130, 132), 0.0f, 0.15f};
}

constexpr uint8_t kRed = 1;
constexpr uint8_t kYellow = 2;

AnalyticScene emptyScene(std::string name) {
    AnalyticScene scene;
    scene.name = std::move(name);
    scene.objects = {"surroundings", "red", "yellow"};
    scene.background = glm::vec3(0.02f);
    return scene;
}

void add(AnalyticScene& scene, uint8_t object, Solid solid) {
    solid.object = object;
    scene.solids.push_back(solid);
}

void addWall(AnalyticScene& scene) {
    add(scene, 0, planeThrough({0.0, 0.0, 1.2}, {0.0, 0.0, -1.0}, greyPaint()));
}

AnalyticScene sphereScene() {
    AnalyticScene scene = emptyScene("sphere");
    add(scene, kRed, sphereAt({0.0, 0.0, 0.7}, 0.1, redPaint()));
    add(scene, kYellow, sphereAt({0.25, 0.0, 0.8}, 0.04, yellowPaint()));
    addWall(scene);
    return scene;
}

// One tilted plane that fills the image.
AnalyticScene planeScene() {
    AnalyticScene scene = emptyScene("plane");
    add(scene, kRed, planeThrough({0.0, 0.0, 0.7}, {0.2, -0.3, -1.0}, redPaint()));
    return scene;
}

AnalyticScene torusScene() {
    AnalyticScene scene = emptyScene("torus");
    add(scene, kRed, torusAt({0.0, 0.0, 0.7}, {0.3, 0.4, -1.0}, 0.1, 0.012, redPaint()));
    add(scene, kYellow, sphereAt({0.0, 0.0, 0.75}, 0.03, yellowPaint()));
    addWall(scene);
    return scene;
}

// Two slabs leave a vertical slot of the given width; what lies behind shows through it.
AnalyticScene slabScene(std::string name, double width) {
    AnalyticScene scene = emptyScene(std::move(name));
    const dvec3 half(0.15, 0.2, 0.05);
    for (const double side : {-1.0, 1.0}) {
        const dvec3 centre(side * (half.x + 0.5 * width), 0.0, 0.75);
        add(scene, kRed, boxAt({centre, dquat(1.0, 0.0, 0.0, 0.0)}, half, redPaint()));
    }
    addWall(scene);
    return scene;
}

// 2 mm thick, seen at 35 degrees, its thin edge in sight.
AnalyticScene plateScene() {
    AnalyticScene scene = emptyScene("plate");
    const dquat turn = rotationExp({0.0, 35.0 * std::numbers::pi / 180.0, 0.0});
    add(scene, kRed, boxAt({{0.0, 0.0, 0.75}, turn}, {0.15, 0.12, 0.001}, redPaint()));
    add(scene, kYellow, sphereAt({0.28, 0.0, 0.9}, 0.04, yellowPaint()));
    addWall(scene);
    return scene;
}

// Three planes at right angles meet in a concave corner straight ahead.
AnalyticScene cornerScene() {
    AnalyticScene scene = emptyScene("corner");
    const dvec3 apex(0.0, 0.0, 0.9);
    for (int i = 0; i < 3; ++i) {
        const double angle = 2.0 * std::numbers::pi * i / 3.0 + 0.3;
        const double across = std::sqrt(2.0 / 3.0);
        const dvec3 normal(across * std::cos(angle), across * std::sin(angle), -std::sqrt(1.0 / 3.0));
        add(scene, kRed, planeThrough(apex, normal, redPaint()));
    }
    return scene;
}

} // namespace

const std::vector<std::string>& analyticSceneNames() {
    static const std::vector<std::string> kNames = {"tank", "sphere", "plane",  "torus",  "slot",
                                                    "gap",  "plate",  "corner", "wetmate"};
    return kNames;
}

std::optional<AnalyticScene> analyticScene(std::string_view name) {
    if (name == "tank") {
        return tankScene();
    }
    if (name == "sphere") {
        return sphereScene();
    }
    if (name == "plane") {
        return planeScene();
    }
    if (name == "torus") {
        return torusScene();
    }
    if (name == "slot") { // a region of 4 cm leaves 4 cm of it open
        return slabScene("slot", 0.12);
    }
    if (name == "gap") { // narrower than two regions: they overlap and close it
        return slabScene("gap", 0.03);
    }
    if (name == "plate") {
        return plateScene();
    }
    if (name == "corner") {
        return cornerScene();
    }
    if (name == "wetmate") {
        return wetmateScene();
    }
    return std::nullopt;
}

double signedDistance(const AnalyticScene& scene, const dvec3& scenePoint) noexcept {
    double nearest = HUGE_VAL;
    for (const Solid& solid : scene.solids) {
        nearest = std::fmin(nearest, signedDistance(solid, scenePoint));
    }
    return nearest;
}

glm::vec3 linearColour(int red, int green, int blue) {
    const auto linear = [](int channel) {
        const double s = channel / 255.0;
        return static_cast<float>(s <= 0.04045 ? s / 12.92 : std::pow((s + 0.055) / 1.055, 2.4));
    };
    return {linear(red), linear(green), linear(blue)};
}

} // namespace fathom
