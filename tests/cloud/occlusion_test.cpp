// SPDX-License-Identifier: Apache-2.0
// Compares occlusion.comp with its float64 twin, and checks its purpose: points hidden from the colour camera
// have no class.
#include "tests/support/cloud_rig.h"
#include "tests/support/sanitized.h"

#include <algorithm>
#include <cmath>
#include <doctest/doctest.h>

using namespace fathom;
using namespace fathom::testing;

namespace {

constexpr uint32_t kRedBytes = 0xff2020c0, kBlue = 0xffc02020;
constexpr double kFront = 0.5, kBack = 1.0; // [m]

CameraInfo parallaxCamera(double focalRatio, double baseline, bool distorted = false) {
    CameraInfo camera = distorted ? freiburgCamera(320, 240, 0.0001) : pinholeCamera(320, 240, 0.0001);
    camera.registered = false;
    camera.colour.width = 400, camera.colour.height = 300;
    camera.colour.fx = camera.depth.fx * focalRatio, camera.colour.fy = camera.depth.fy * focalRatio;
    camera.colour.cx = 201.3, camera.colour.cy = 148.6;
    camera.colour.distortion =
        distorted ? std::array{0.05, -0.1, 0.001, -0.002, 0.03} : std::array<double, 5>{};
    camera.colourTdepth = {{baseline, 0.002, 0.001}, rotationExp({0.002, 0.004, -0.003})};
    return camera;
}

// A red plate, rotated about y by `tilt`, in front of a blue wall. The plate spans |x|, |y| <= 0.06 m in its
// own plane.
struct Plate {
    double tilt = 0.0;
    static constexpr double kHalf = 0.06;

    // Intersection of a line with the plate's plane, in the plate's axes [m]; z = distance along the line.
    dvec3 meet(const dvec3& from, const dvec3& along) const {
        const dvec3 x(std::cos(tilt), 0.0, std::sin(tilt)), normal(-x.z, 0.0, x.x), centre(0.0, 0.0, kFront);
        const double t = glm::dot(centre - from, normal) / glm::dot(along, normal);
        const dvec3 p = from + t * along - centre;
        return {glm::dot(p, x), p.y, t};
    }
    // Distance inside the outline (> 0) or outside it (< 0) [m].
    double inside(const dvec3& from, const dvec3& along) const {
        const dvec3 p = meet(from, along);
        return kHalf - std::max(std::abs(p.x), std::abs(p.y));
    }
};

Image plateBeforeWall(const CameraInfo& camera, const Plate& plate) {
    Image image = drawnImage(camera, [&](int u, int v) {
        const dvec3 along(camera.depth.ray(u, v), 1.0);
        return plate.inside(dvec3(0.0), along) >= 0.0 ? plate.meet(dvec3(0.0), along).z : kBack;
    });
    // Renders the colour image by casting the colour camera's rays at the two planes.
    const Pose depthTcolour = inverse(camera.colourTdepth);
    for (uint32_t v = 0; v < camera.colour.height; ++v) {
        for (uint32_t u = 0; u < camera.colour.width; ++u) {
            const dvec3 along = depthTcolour.rotation * dvec3(camera.colour.ray(u, v), 1.0);
            image.colour[v * camera.colour.width + u] =
                plate.inside(depthTcolour.position, along) >= 0.0 ? kRedBytes : kBlue;
        }
    }
    return image;
}

struct LookCounts {
    uint32_t hidden = 0, leaked = 0, seen = 0, wrong = 0, outside = 0;
};

// Counts the outcome of each pixel at least `border` [m] away from the plate's outline.
LookCounts countLooks(const CloudRig& rig, const Plate& plate, double border) {
    const std::vector<uint32_t> masks = rig.masks();
    const reference::FrameView view = rig.view();
    const CameraInfo& camera = rig.camera();
    const dvec3 eye = inverse(camera.colourTdepth).position;
    LookCounts n;
    for (int v = 0; v < rig.height(); ++v) {
        for (int u = 0; u < rig.width(); ++u) {
            const dvec3 p = view.point(u, v, view.z(u, v));
            const uint32_t colour = masks[view.index(u, v)] & 3u;
            const reference::NearestPixel at =
                reference::nearestPixel(camera.colour, camera.colourTdepth.apply(p), 0.0);
            if (at.u < 0 || at.v < 0 || at.u >= 400 || at.v >= 300) {
                n.outside += colour != 0;
            } else if (p.z < kBack) {
                const bool inner = plate.inside(dvec3(0.0), p) > border;
                n.seen += inner, n.wrong += inner && colour != 1u;
            } else if (std::abs(plate.inside(eye, p - eye)) > border) {
                const bool behind = plate.inside(eye, p - eye) > 0.0;
                n.hidden += behind, n.leaked += behind && colour != 0;
                n.seen += !behind, n.wrong += !behind && colour != 2u;
            }
        }
    }
    return n;
}

Scene colourScene() {
    Scene scene = plainScene();
    scene.fixtures = {forbiddenClass("red", 0.02), forbiddenClass("blue", 0.01),
                      forbiddenClass("any", 0.005)};
    scene.fixtures[0].hue = Band{330, 30};
    scene.fixtures[1].hue = Band{200, 260};
    return scene;
}

// Oracle for real frames: brute-force nearest point per colour pixel, without cells. Returns the number of
// points behind another one, and how many of those have a class nevertheless.
std::pair<uint32_t, uint32_t> hiddenByPixel(const CloudRig& rig) {
    const reference::FrameView view = rig.view();
    const Intrinsics& lens = rig.camera().colour;
    const std::vector<uint32_t> masks = rig.masks();
    std::vector<double> front(lens.pixels(), HUGE_VAL);
    uint32_t hidden = 0, leaked = 0;
    for (const bool look : {false, true}) {
        for (int v = 0; v < rig.height(); ++v) {
            for (int u = 0; u < rig.width(); ++u) {
                const double z = view.z(u, v);
                const dvec3 q = rig.camera().colourTdepth.apply(view.point(u, v, z));
                const reference::NearestPixel at = reference::nearestPixel(lens, q, 1e-3);
                if (z == 0.0 || at.unsure || at.u < 0 || at.v < 0 || at.u >= static_cast<int>(lens.width) ||
                    at.v >= static_cast<int>(lens.height)) {
                    continue;
                }
                double& nearest = front[static_cast<size_t>(at.v) * lens.width + static_cast<size_t>(at.u)];
                nearest = look ? nearest : std::min(nearest, q.z);
                const bool behind = look && q.z > 1.021 * nearest + 0.005;
                hidden += behind, leaked += behind && masks[view.index(u, v)] != 0;
            }
        }
    }
    return {hidden, leaked};
}

struct OcclusionAgreement {
    uint32_t cells = 0, masks = 0, unsureMasks = 0, marked = 0;
    double worst = 0.0;
};

OcclusionAgreement compareWithTwins(const CloudRig& rig) {
    const reference::CellBounds twin = reference::occlusion(rig.view(), 1e-3);
    const reference::CellImage cells = rig.cells();
    OcclusionAgreement a;
    REQUIRE(cells.edge == twin.sure.edge);
    REQUIRE(cells.nearest.size() == twin.sure.nearest.size());
    for (size_t i = 0; i < cells.nearest.size(); ++i) {
        const double z = cells.nearest[i], below = twin.possible.nearest[i] - z,
                     above = z - twin.sure.nearest[i];
        a.cells += std::isfinite(z);
        if (std::isfinite(z) || std::isfinite(twin.sure.nearest[i])) {
            a.worst = std::max({a.worst, below, above}) / 1.0;
        }
    }
    const reference::ClassImage classes = reference::classify(rig.view(), &cells);
    const std::vector<uint32_t> masks = rig.masks();
    for (size_t i = 0; i < masks.size(); ++i) {
        const bool different = masks[i] != classes.masks[i];
        a.marked += masks[i] != 0;
        a.masks += different && classes.unsure[i] == 0;
        a.unsureMasks += different && classes.unsure[i] != 0;
    }
    return a;
}

} // namespace

TEST_CASE("Occlusion cells and looked-up class bits equal the twins' for several focal ratios, baselines and "
          "lenses") {
    double worst = 0.0;
    uint32_t cells = 0, unsure = 0, marked = 0;
    for (const double ratio : {0.7, 1.0, 1.6}) {
        for (const double baseline : {0.015, -0.06}) {
            for (const bool distorted : {false, true}) {
                CAPTURE(ratio);
                CAPTURE(baseline);
                CAPTURE(distorted);
                const CameraInfo camera = parallaxCamera(ratio, baseline, distorted);
                CloudRig rig(colourScene(), camera);
                rig.run(stressImage(camera, 31));
                const OcclusionAgreement a = compareWithTwins(rig);
                CHECK(a.worst < 1e-6);
                CHECK(a.masks == 0);
                cells += a.cells, unsure += a.unsureMasks, marked += a.marked,
                    worst = std::max(worst, a.worst);
            }
        }
    }
    CHECK(cells > 100000);
    CHECK(unsure < marked / 2000);
    MESSAGE("occlusion: largest error ", worst * 1e6, " um over ", cells, " cells; ", unsure, " of ", marked,
            " marked pixels differ, all within 1e-3 pixels of a border between two colour pixels");
}

TEST_CASE("Points that a nearer plate hides from the colour camera have no class, and all others get their "
          "own colour") {
    for (const double ratio : {0.8, 1.0, 1.6}) {
        for (const double baseline : {0.03, -0.05}) {
            for (const double tilt : {0.0, 0.9, -0.9}) {
                if (kSanitized && (ratio != 1.6 || baseline > 0.0)) {
                    continue;
                }
                CAPTURE(ratio);
                CAPTURE(baseline);
                CAPTURE(tilt);
                const CameraInfo camera = parallaxCamera(ratio, baseline);
                const Plate plate{tilt};
                CloudRig rig(colourScene(), camera);
                rig.run(plateBeforeWall(camera, plate));
                const double pixels = 3.0 * kFront / std::min(camera.depth.fx, camera.colour.fx);
                const LookCounts n = countLooks(rig, plate, pixels / std::cos(std::abs(tilt) + 0.1));
                CHECK(n.hidden > 100);
                CHECK(n.leaked == 0);
                CHECK(n.seen > 10000);
                CHECK(n.wrong == 0);
                CHECK(n.outside == 0);
            }
        }
    }
}

TEST_CASE("A class without colour gates accepts hidden points") {
    const CameraInfo camera = parallaxCamera(1.6, 0.05);
    CloudRig rig(colourScene(), camera);
    const FrameReport report = rig.run(plateBeforeWall(camera, Plate{}));
    CHECK(report.counts.classPixels[2] == report.counts.valid);
    CHECK(report.counts.classPixels[0] + report.counts.classPixels[1] < report.counts.valid);
}

TEST_CASE("Two-plane and empty frames of one pixel pass through the occlusion pass") {
    CameraInfo camera = parallaxCamera(1.0, 0.01);
    camera.depth.width = camera.depth.height = 1;
    camera.depth.cx = camera.depth.cy = 0.0;
    for (const double z : {0.0, 0.8}) {
        CloudRig rig(colourScene(), camera);
        const FrameReport report = rig.run(drawnImage(
            camera, [&](int, int) { return z; }, kRedBytes));
        CHECK(report.counts.valid == (z > 0.0));
        CHECK(report.counts.classPixels[0] == (z > 0.0));
        CHECK(compareWithTwins(rig).masks == 0);
    }
}

TEST_CASE("In the unregistered D435 frame, the twins agree and points behind a nearer point of the same "
          "colour pixel have no class") {
    const RecordedShots shots = recordedShots("realsense_bag", {0});
    if (shots.images.empty()) {
        return;
    }
    Scene scene = plainScene();
    scene.farZ = 10.0;
    scene.fixtures = {forbiddenClass("red case", 0.02), forbiddenClass("any colour", 0.01)};
    scene.fixtures[0].hue = Band{345, 14}, scene.fixtures[0].saturation = Band{0.6, 1},
    scene.fixtures[0].lightness = Band{0.1, 0.7};
    scene.fixtures[1].lightness = Band{0.0, 0.999};
    CloudRig rig(scene, shots.camera);
    const FrameReport report = rig.run(shots.images[0]);
    REQUIRE(rig.plan().occlusion);
    const OcclusionAgreement a = compareWithTwins(rig);
    CHECK(a.worst < 1e-5); // at ranges up to 10 m
    CHECK(a.masks == 0);
    const auto [hidden, leaked] = hiddenByPixel(rig);
    CHECK(leaked == 0);
    MESSAGE("D435: ", report.counts.valid, " valid, ", hidden, " hidden, red case ",
            report.counts.classPixels[0], " pixels, cells within ", a.worst * 1e6, " um, ", a.unsureMasks,
            " masks on a border");
    CHECK(report.counts.classPixels[0] > 500);
    CHECK(hidden > 0);
}
