// SPDX-License-Identifier: Apache-2.0
#include "devices/simulated/tank_scene.h"

#include "devices/simulated/paints.h"

#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

namespace fathom {

namespace {

const Paint kFrame{linearColour(120, 134, 148), 0.10f, 0.25f};
const Paint kGreyPipe{linearColour(150, 158, 164), 0.25f, 0.25f};
const Paint kGreenPipe{linearColour(64, 122, 92), 0.20f, 0.25f};
const Paint kBrass{linearColour(164, 132, 104), 0.35f, 0.15f};
const Paint kWhite{linearColour(226, 230, 230), 0.05f, 0.05f};
const Paint kFloor{linearColour(96, 108, 104), 0.0f, 0.9f};

class Builder {
public:
    explicit Builder(AnalyticScene& scene)
        : scene_(scene) {}
    void object(uint8_t row) { object_ = row; }
    void operator()(Solid solid) {
        solid.object = object_;
        scene_.solids.push_back(solid);
    }
    void box(const dvec3& centre, const dvec3& half, const Paint& paint) {
        (*this)(boxAt({centre, dquat(1.0, 0.0, 0.0, 0.0)}, half, paint));
    }

private:
    AnalyticScene& scene_;
    uint8_t object_ = 0;
};

void addRoom(Builder& put) {
    put(planeThrough({0.0, 0.0, 1.75}, {0.0, 0.0, -1.0}, paint::kWall));
    put(planeThrough({0.0, 0.52, 0.0}, {0.0, -1.0, 0.0}, kFloor));
}

void addPanel(Builder& put) {
    put.box({0.0, 0.0, 1.02}, {0.45, 0.28, 0.02}, paint::kPanel);
    for (const double side : {-1.0, 1.0}) {
        put.box({0.0, side * 0.285, 1.01}, {0.47, 0.015, 0.035}, kFrame);
        put.box({side * 0.46, 0.0, 1.01}, {0.015, 0.30, 0.035}, kFrame);
        put(cylinderBetween({side * 0.38, 0.30, 1.02}, {side * 0.38, 0.52, 1.02}, 0.022, kFrame));
        for (const double row : {-0.245, 0.245}) {
            put(cylinderBetween({side * 0.42, row, 1.0}, {side * 0.42, row, 0.990}, 0.013, paint::kSteel));
            put(sphereAt({side * 0.42, row, 0.992}, 0.008, paint::kSteel));
        }
    }
}

void addPipesBehind(Builder& put) {
    const auto run = [&](const dvec3& a, const dvec3& b, double radius, const Paint& paint) {
        put(cylinderBetween(a, b, radius, paint));
        const dvec3 along = glm::normalize(b - a);
        for (const double share : {0.22, 0.7}) {
            const dvec3 flange = a + share * (b - a);
            put(cylinderBetween(flange - 0.012 * along, flange + 0.012 * along, 1.5 * radius, paint));
        }
    };
    run({-1.2, -0.40, 1.22}, {1.2, -0.40, 1.22}, 0.036, kGreenPipe);
    run({-1.2, 0.40, 1.30}, {1.2, 0.40, 1.30}, 0.030, kGreyPipe);
    run({-0.60, -0.9, 1.35}, {-0.60, 0.52, 1.35}, 0.042, kGreyPipe);
    run({0.58, -0.9, 1.15}, {0.58, 0.52, 1.15}, 0.030, kGreenPipe);
    run({0.69, -0.9, 1.45}, {0.69, 0.52, 1.45}, 0.030, kBrass);
}

// A pipe in front of the panel with bends into it, and the brass body that the wheel's stem comes out of.
void addValvePipe(Builder& put, double x) {
    const double z = 0.945;
    for (const double side : {-1.0, 1.0}) {
        put(cylinderBetween({x, 0.0, z}, {x, side * 0.20, z}, 0.020, kGreyPipe));
        put(sphereAt({x, side * 0.20, z}, 0.020, kGreyPipe));
        put(cylinderBetween({x, side * 0.20, z}, {x, side * 0.20, 1.0}, 0.020, kGreyPipe));
        put(cylinderBetween({x, side * 0.20, 0.99}, {x, side * 0.20, 1.0}, 0.034, paint::kSteel));
        put(cylinderBetween({x, side * 0.050, z}, {x, side * 0.066, z}, 0.033, kBrass));
    }
    put(sphereAt({x, 0.0, z}, 0.037, kBrass));
    put(cylinderBetween({x, -0.050, z}, {x, 0.050, z}, 0.026, kBrass));
}

// Rim, hub, spokes that rise from the hub to the rim; the stem is steel and no part of the valve's colour.
void addWheel(Builder& put, const dvec3& centre, const dvec3& axis, double turn, const Paint& paint,
              uint8_t object) {
    const dvec3 outward = glm::normalize(axis); // towards the camera
    const dvec3 u = glm::normalize(glm::cross(dvec3(0.0, 1.0, 0.0), outward));
    const dvec3 v = glm::cross(outward, u);
    put.object(object);
    put(torusAt(centre, outward, 0.070, 0.0095, paint));
    put(cylinderBetween(centre - 0.020 * outward, centre + 0.004 * outward, 0.020, paint));
    for (int i = 0; i < 5; ++i) {
        const double angle = turn + 2.0 * std::numbers::pi * i / 5.0;
        const dvec3 radial = std::cos(angle) * u + std::sin(angle) * v;
        put(capsuleBetween(centre - 0.010 * outward + 0.016 * radial, centre + 0.069 * radial, 0.0060,
                           paint));
    }
    put.object(0);
    put(cylinderBetween(centre - 0.085 * outward, centre + 0.010 * outward, 0.008, paint::kSteel));
    put(cylinderBetween(centre - 0.085 * outward, centre - 0.045 * outward, 0.019, kBrass));
    put(sphereAt(centre + 0.010 * outward, 0.008, paint::kSteel));
}

void addGauge(Builder& put, const dvec3& centre) {
    const dvec3 out(0.0, 0.0, -1.0);
    put(cylinderBetween(centre, centre + 0.024 * out, 0.050, paint::kBlack));
    put(cylinderBetween(centre + 0.024 * out, centre + 0.025 * out, 0.043, kWhite));
    const dvec3 face = centre + 0.025 * out;
    for (int i = 0; i < 9; ++i) {
        const double angle = (135.0 + 33.75 * i) * std::numbers::pi / 180.0;
        const dvec3 radial(std::cos(angle), std::sin(angle), 0.0);
        put(capsuleBetween(face + 0.032 * radial, face + 0.038 * radial, 0.0016, paint::kBlack));
    }
    put(capsuleBetween(face + 0.002 * out, face + 0.002 * out + dvec3(0.016, -0.026, 0.0), 0.0020,
                       paint::kBlack));
    put(sphereAt(face, 0.006, paint::kSteel));
    put(cylinderBetween(centre + dvec3(0.0, 0.05, -0.012), centre + dvec3(0.0, 0.085, -0.012), 0.010,
                        kBrass));
}

void addPlates(Builder& put) {
    for (const double x : {-0.30, 0.30}) {
        put.box({x, 0.16, 0.998}, {0.045, 0.026, 0.003}, kWhite);
        put.box({x, 0.150, 0.996}, {0.034, 0.005, 0.002}, paint::kBlack);
        put.box({x - 0.010, 0.167, 0.996}, {0.024, 0.004, 0.002}, paint::kBlack);
    }
}

} // namespace

AnalyticScene tankScene() {
    AnalyticScene scene;
    scene.name = "tank";
    scene.objects = {"surroundings", "red valve", "yellow valve"};
    scene.underwater = true;
    scene.background = glm::vec3(0.01f, 0.05f, 0.07f);
    Builder put(scene);
    addRoom(put);
    addPanel(put);
    addPipesBehind(put);
    addValvePipe(put, -0.15);
    addValvePipe(put, 0.15);
    addWheel(put, {-0.15, 0.0, 0.86}, {0.10, -0.16, -1.0}, 0.35, paint::kRed, 1);
    addWheel(put, {0.15, 0.0, 0.86}, {-0.14, -0.12, -1.0}, 0.85, paint::kYellow, 2);
    addGauge(put, {0.0, -0.15, 1.0});
    addPlates(put);
    return scene;
}

} // namespace fathom
