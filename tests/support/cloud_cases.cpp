// SPDX-License-Identifier: Apache-2.0
// Cameras, scenes and frames of the tests of the frame passes.
#include "devices/recorded/recorded_camera.h"
#include "engine/types/colour_copy.h"
#include "tests/support/cloud_rig.h"
#include "tests/support/sanitized.h"

#include <algorithm>
#include <cmath>
#include <doctest/doctest.h>
#include <random>

namespace fathom::testing {

namespace {

// A well-mixed hash of a pixel and a seed (splitmix64).
uint64_t mixed(uint64_t x) {
    x += 0x9e3779b97f4a7c15ull;
    x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9ull;
    x = (x ^ (x >> 27)) * 0x94d049bb133111ebull;
    return x ^ (x >> 31);
}

double share(uint64_t x) {
    return static_cast<double>(mixed(x) >> 11) * 0x1p-53;
}

uint16_t toUnits(double metres, const CameraInfo& camera) {
    return static_cast<uint16_t>(std::clamp(std::round(metres / camera.metresPerUnit), 0.0, 65535.0));
}

Band band(double lo, double hi) {
    return {lo, hi};
}

CloudCase makeCase(std::string name, Scene scene, CameraInfo camera, uint64_t seed) {
    return {std::move(name), std::move(scene), camera, stressImage(camera, seed)};
}

Scene withFilter(Scene scene, uint32_t radius, double edge, double budget) {
    scene.filter.radius = radius;
    scene.filter.edge = edge;
    scene.errorBudget = budget;
    return scene;
}

} // namespace

CloudRig::Change queriedByGpu(bool pack) {
    return [pack](Plan& plan) {
        plan.query = Plan::Query::Gpu;
        plan.tree = true;
        plan.pack = plan.byPixel = pack;
        plan.memoryTexels = plan.memoryTexels && !pack;
    };
}

Tool leafyTool(size_t leaves, double size) {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> side(-size, size), radius(0.002, 0.01);
    std::vector<Sphere> spheres;
    for (size_t i = 0; i < leaves; ++i) {
        spheres.push_back({{side(random), side(random), side(random)}, radius(random)});
    }
    return Tool(buildSphereTree(spheres));
}

CameraInfo pinholeCamera(uint32_t width, uint32_t height, double metresPerUnit) {
    CameraInfo camera;
    camera.depth.width = width, camera.depth.height = height;
    camera.depth.fx = 0.9 * std::max(width, 32u), camera.depth.fy = 0.91 * std::max(width, 32u);
    camera.depth.cx = 0.49 * width, camera.depth.cy = 0.53 * height;
    camera.colour = camera.depth;
    camera.metresPerUnit = metresPerUnit;
    return camera;
}

CameraInfo freiburgCamera(uint32_t width, uint32_t height, double metresPerUnit) {
    CameraInfo camera = pinholeCamera(width, height, metresPerUnit);
    const double k = width / 640.0;
    camera.depth.fx = 517.3 * k, camera.depth.fy = 516.5 * k, camera.depth.cx = 318.6 * k,
    camera.depth.cy = 255.3 * k;
    camera.depth.distortion = {0.2624, -0.9531, -0.0054, 0.0026, 1.1633};
    camera.colour = camera.depth;
    return camera;
}

FixtureClass forbiddenClass(const std::string& name, double radius) {
    FixtureClass f;
    f.name = name;
    f.radius = radius;
    return f;
}

FixtureClass guidanceClass(const std::string& name) {
    FixtureClass f;
    f.name = name;
    f.role = Role::Guidance;
    f.minCount = 1;
    return f;
}

Scene plainScene() {
    Scene scene;
    scene.filter = {0, 0.01, 0.0};
    scene.errorBudget = 0.0;
    scene.holdSeconds = 0.0;
    scene.fixtures = {forbiddenClass("all", 0.04)};
    return scene;
}

Scene classesScene(uint32_t count) {
    Scene scene = plainScene();
    scene.registrationSigma = 0.001;
    scene.fixtures.clear();
    for (uint32_t c = 0; c < count; ++c) {
        const std::string name(1, static_cast<char>('a' + c));
        FixtureClass f = c % 3 == 1 ? guidanceClass(name) : forbiddenClass(name, 0.02 + 0.01 * (c % 4));
        switch (c) {
        case 0:
            f.hue = band(345, 20), f.saturation = band(0.45, 1), f.lightness = band(0.05, 0.9);
            break;
        case 1:
            f.hue = band(300, 60);
            break;
        case 2:
            f.lightness = band(0.2, 0.8);
            break;
        case 3:
            f.box = Box{{-0.3, -0.2, 0.5}, {0.25, 0.3, 1.5}};
            break;
        case 4:
            f.saturation = band(0, 0.5);
            break;
        case 5:
            f.hue = band(110, 165.5), f.box = Box{{-1, -1, 0}, {1, 1, 1}};
            break;
        case 6:
            break; // accepts every valid point
        default:
            f.hue = band(0, 360);
            break;
        }
        scene.fixtures.push_back(f);
    }
    return scene;
}

Image stressImage(const CameraInfo& camera, uint64_t seed) {
    Image image;
    const uint32_t w = camera.depth.width, h = camera.depth.height;
    for (uint32_t i = 0; i < camera.depth.pixels(); ++i) {
        const uint32_t row = i / w;
        const double x = (i % w + 0.5) / w, y = (row + 0.5) / h;
        const uint64_t key = seed * 0x100000000ull + i * 4ull;
        double z = 0.6 + 0.3 * x + 0.2 * std::sin(5.0 * y);
        z += std::hypot(x - 0.5, y - 0.4) < 0.25 ? -0.25 : 0.0; // a step
        z += x > 0.8 ? 1.2 * (x - 0.8) / 0.2 : 0.0;             // a steep slope
        z += (share(key) - 0.5) * 0.004;
        z = share(key + 1) < 0.03 ? 0.15 + 4.0 * share(key + 2) : z; // speckles, some beyond far
        image.depth.push_back(share(key + 1) > 0.95 ? uint16_t{0} : toUnits(z, camera));
    }
    const uint32_t cw = camera.colour.width;
    for (uint32_t i = 0; i < camera.colour.pixels(); ++i) {
        const uint64_t block = (i / cw / 6) * 4096ull + (i % cw) / 6, key = mixed(seed + block * 7919);
        const uint32_t noise = static_cast<uint32_t>(mixed(key + i) & 0x070707),
                       grey = static_cast<uint32_t>(key >> 40 & 255) * 0x010101;
        const uint32_t colour = static_cast<uint32_t>(key) & 0xf8f8f8;
        image.colour.push_back(0xff000000u | (key % 11 == 0   ? grey
                                              : key % 13 == 0 ? 0xffffffu
                                              : key % 17 == 0 ? 0u
                                                              : colour | noise));
    }
    return image;
}

Image drawnImage(const CameraInfo& camera, const std::function<double(int, int)>& depth, uint32_t colour) {
    Image image;
    for (uint32_t v = 0; v < camera.depth.height; ++v) {
        for (uint32_t u = 0; u < camera.depth.width; ++u) {
            image.depth.push_back(toUnits(depth(static_cast<int>(u), static_cast<int>(v)), camera));
        }
    }
    image.colour.assign(camera.colour.pixels(), colour);
    return image;
}

double planeDepth(const CameraInfo& camera, int u, int v, const dvec3& normal, double d) {
    const glm::dvec2 ray = camera.depth.ray(u, v);
    return d / (normal.x * ray.x + normal.y * ray.y + normal.z);
}

Shot simulatedShot(const std::string& scene, SimulatedCameraOptions options, uint32_t frame) {
    options.firstFrame = frame, options.frames = frame + 1;
    SimulatedCamera camera(*analyticScene(scene), options);
    const Frame taken = *camera.next();
    return {camera.info(),
            {{taken->depth.begin(), taken->depth.end()}, {taken->colour.begin(), taken->colour.end()}},
            *taken->baseTcamera};
}

std::vector<CloudCase> cloudCases() {
    std::vector<CloudCase> cases;
    cases.push_back(makeCase("1x1", plainScene(), pinholeCamera(1, 1), 1));
    cases.push_back(makeCase("15x17, filter 1, 0.1 mm", withFilter(classesScene(2), 1, 0.03, 0.0001),
                             pinholeCamera(15, 17, 0.0001), 2));
    cases.push_back(
        makeCase("16x16, filter 16", withFilter(classesScene(3), 16, 0.03, 0.001), pinholeCamera(16, 16), 3));
    cases.push_back(makeCase("33x7, freiburg1, filter 5", withFilter(classesScene(8), 5, 0.03, 0.0),
                             freiburgCamera(33, 7), 4));
    cases.push_back(makeCase("75x61, freiburg1, filter 16", withFilter(classesScene(4), 16, 0.05, 0.0003),
                             freiburgCamera(75, 61), 5));
    cases.push_back(makeCase("428x240, filter 2", withFilter(classesScene(8), 2, 0.03, 0.0001),
                             pinholeCamera(428, 240), 6));
    if (kSanitized) {
        return cases;
    }
    cases.push_back(makeCase("428x240, freiburg1, filter 5, no edge",
                             withFilter(classesScene(5), 5, 0.0, 0.0002), freiburgCamera(428, 240), 7));
    cases.push_back(makeCase("640x480, no filter", withFilter(classesScene(7), 0, 0.03, 0.0001),
                             pinholeCamera(640, 480), 8));
    Shot tank = simulatedShot("tank", {});
    Scene scene = withFilter(classesScene(2), 2, 0.03, 0.0001);
    scene.baseTcamera = {{100000.0, -100000.0, 50.0}, rotationExp({0.4, -0.9, 1.7})}; // 140 km away
    cases.push_back({"640x480, tank, 140 km away", scene, tank.camera, tank.image});
    return cases;
}

RecordedShots recordedShots(const std::string& name, std::vector<uint32_t> frames) {
    const std::filesystem::path folder = std::filesystem::path("../shared/data") / name;
    RecordedShots out;
    if (!std::filesystem::exists(folder)) {
        MESSAGE("SKIPPED: there is no recording ", folder.string());
        return out;
    }
    RecordedCamera camera(folder);
    out.camera = camera.info();
    while (const std::optional<Frame> frame = camera.next()) {
        if (frames.empty() || std::find(frames.begin(), frames.end(), (*frame)->index) != frames.end()) {
            out.images.push_back({{(*frame)->depth.begin(), (*frame)->depth.end()}, coloursOf(**frame)});
        }
    }
    return out;
}

} // namespace fathom::testing
