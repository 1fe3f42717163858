// SPDX-License-Identifier: Apache-2.0
// Memory of points: scripted sequences of tiny frames, and whole noisy sequences against the float64 twin.
#include "engine/reference/hold.h"
#include "tests/support/cloud_rig.h"

#include <algorithm>
#include <cmath>
#include <doctest/doctest.h>

using namespace fathom;
using namespace fathom::testing;

namespace {

constexpr uint32_t kRed = 0xff2020c0, kGrey = 0xff808080;
constexpr double kWall = 0.6; // [m]

Scene holdScene(double seconds) {
    Scene scene = plainScene();
    scene.holdSeconds = seconds;
    scene.fixtures[0].hue = Band{330, 30};
    return scene;
}

bool inTarget(int u, int v) {
    return u >= 18 && u < 24 && v >= 10 && v < 14;
}
constexpr uint32_t kTarget = 24; // pixels

// A grey wall with a red target of given depth and colour.
Image script(const CameraInfo& camera, double targetDepth, uint32_t targetColour = kRed) {
    Image image = drawnImage(
        camera, [&](int u, int v) { return inTarget(u, v) ? targetDepth : kWall; }, kGrey);
    for (int v = 0; v < static_cast<int>(camera.depth.height); ++v) {
        for (int u = 0; u < static_cast<int>(camera.depth.width); ++u) {
            if (inTarget(u, v)) {
                image.colour[static_cast<size_t>(v) * camera.depth.width + static_cast<size_t>(u)] =
                    targetColour;
            }
        }
    }
    return image;
}

uint32_t countOf(const std::vector<reference::RegionSphere>& spheres) {
    return static_cast<uint32_t>(
        std::count_if(spheres.begin(), spheres.end(), [](const auto& s) { return s.radius >= 0.0; }));
}

// Shows the red target once at t = 0, then `later` at 30 Hz. Returns the number of held spheres in each later
// frame.
std::vector<uint32_t> heldAfter(CloudRig& rig, const Image& later, int frames) {
    rig.run(script(rig.camera(), kWall), 0.0);
    REQUIRE(countOf(rig.spheres()) == kTarget);
    const auto seen = rig.spheres();
    std::vector<uint32_t> counts;
    for (int k = 1; k <= frames; ++k) {
        const FrameReport report = rig.run(later, k / 30.0);
        const auto held = rig.spheres(true);
        counts.push_back(countOf(held));
        CHECK(report.counts.spheres == countOf(held) + countOf(rig.spheres()));
        for (size_t i = 0; i < held.size(); ++i) {
            if (held[i].radius >= 0.0) {
                CHECK(glm::distance(held[i].centre, seen[i].centre) < 1e-12);
                CHECK(held[i].radius == seen[i].radius);
                CHECK(held[i].cls == 0);
            }
        }
    }
    return counts;
}

// A frame with a moving bar nearer than all else.
Image sweptImage(const Frame& frame, uint32_t width) {
    Image image{{frame->depth.begin(), frame->depth.end()}, {frame->colour.begin(), frame->colour.end()}};
    for (size_t i = 0; i < image.depth.size(); ++i) {
        if (i % width / 12 == frame->index % 13) {
            image.depth[i] = 300;
        }
    }
    return image;
}

struct HoldAgreement {
    uint32_t held = 0, different = 0, wrong = 0; // wrong: different away from thresholds
    double worst = 0.0;                          // [m]
};

void compareHeld(const std::vector<reference::RegionSphere>& here,
                 const std::vector<reference::RegionSphere>& there, const std::vector<uint8_t>& unsure,
                 HoldAgreement& a) {
    for (size_t i = 0; i < here.size(); ++i) {
        const double apart = std::max(glm::distance(here[i].centre, there[i].centre),
                                      std::abs(here[i].radius - there[i].radius));
        const bool same = here[i].cls == there[i].cls && (here[i].cls < 0 || apart < 1e-6);
        a.held += here[i].radius >= 0.0;
        a.different += !same;
        a.wrong += !same && unsure[i] == 0;
        a.worst = same && here[i].cls >= 0 ? std::max(a.worst, apart) : a.worst;
    }
}

const CameraInfo kCamera = pinholeCamera(40, 24);
const std::vector<uint32_t> kSixFrames{24, 24, 24, 24, 24, 24, 0, 0};
const std::vector<uint32_t> kNothing(8, 0);

} // namespace

TEST_CASE("Points without depth are held for hold_s after they were last seen, then dropped") {
    CloudRig rig(holdScene(0.2), kCamera);
    CHECK(heldAfter(rig, script(kCamera, 0.0), 8) == kSixFrames); // 0.2 s are six frames
    CHECK(rig.counters().patchGroups.x == 0);                     // no patch stays listed without points
}

TEST_CASE("Points behind a nearer occluder are held for hold_s") {
    CloudRig rig(holdScene(0.2), kCamera);
    CHECK(heldAfter(rig, script(kCamera, 0.4, kGrey), 8) == kSixFrames);
}

TEST_CASE("Points are dropped at once when their pixel shows a deeper surface or another colour at the same "
          "depth") {
    CloudRig deeper(holdScene(0.2), kCamera), other(holdScene(0.2), kCamera);
    CHECK(heldAfter(deeper, script(kCamera, 0.9, kGrey), 8) == kNothing);
    CHECK(heldAfter(other, script(kCamera, kWall, kGrey), 8) == kNothing);
}

TEST_CASE("An occluder counts as nearer from 3 sigma of depth on") {
    const double three = 3.0 * depthSigma(kWall); // 4.2 mm
    CloudRig within(holdScene(0.2), kCamera), beyond(holdScene(0.2), kCamera);
    CHECK(heldAfter(within, script(kCamera, kWall - three + 0.0012, kGrey), 8) == kNothing);
    CHECK(heldAfter(beyond, script(kCamera, kWall - three - 0.0012, kGrey), 8) == kSixFrames);
}

TEST_CASE("With hold 0 no points are held and no memory is allocated") {
    CloudRig rig(holdScene(0.0), kCamera);
    rig.run(script(kCamera, kWall));
    const FrameReport report = rig.run(script(kCamera, 0.0));
    CHECK(report.counts.spheres == 0);
    CHECK_FALSE(rig.plan().hold);
    for (const gpu::Buffer* buffer :
         {&rig.cycle().work().seen, &rig.cycle().work().kept, &rig.cycle().work().keptTime,
          &rig.cycle().work().memoryCounts, &rig.cycle().work().heldRadii}) {
        CHECK_FALSE(static_cast<bool>(*buffer));
    }
}

TEST_CASE("A flickering pixel has exactly one sphere in every frame") {
    CloudRig rig(holdScene(0.1), kCamera);
    rig.run(script(kCamera, kWall));
    for (int k = 1; k < 12; ++k) {
        const FrameReport report = rig.run(script(kCamera, k % 3 == 0 ? kWall : 0.0));
        CHECK(report.counts.spheres == kTarget);
        CHECK(countOf(rig.spheres(k % 3 != 0)) == kTarget);
        CHECK(rig.host().spheres.source[0] >= (k % 3 != 0 ? kCamera.depth.pixels() : 0u));
    }
}

TEST_CASE("A held point stays fixed in the base frame while the camera moves, also outside the image") {
    Scene scene = holdScene(0.2);
    scene.baseTcamera = {{1000.0, -2000.0, 5.0}, rotationExp({0.3, -0.2, 0.1})};
    CloudRig rig(scene, kCamera);
    rig.run(script(kCamera, kWall), 0.0, scene.baseTcamera);
    const auto seen = rig.spheres();
    for (int k = 1; k <= 6; ++k) {
        const Pose aside{{0.8 * k, 0.0, 0.0},
                         rotationExp({0.0, 0.02 * k, 0.0})}; // far outside the first view
        rig.run(drawnImage(
                    kCamera, [](int, int) { return kWall; }, kGrey),
                k / 30.0, scene.baseTcamera * aside);
        const auto held = rig.spheres(true);
        REQUIRE(countOf(held) == kTarget);
        for (size_t i = 0; i < held.size(); ++i) {
            CHECK((held[i].radius < 0.0 || glm::distance(held[i].centre, seen[i].centre) < 1e-9));
        }
    }
    // Back in view, where a hole shows the wall behind: the point is contradicted.
    rig.run(drawnImage(
                kCamera, [](int, int) { return 1.5; }, kGrey),
            6 / 30.0 + 0.001, scene.baseTcamera);
    CHECK(countOf(rig.spheres(true)) == 0);
}

TEST_CASE("A held point outside the image stays where the polynomials of the lens fold it into the image") {
    CameraInfo camera = kCamera; // lens of TUM freiburg2, depth
    camera.depth.fx = camera.depth.fy = 43.5;
    camera.depth.distortion = {-0.2297, 1.4766, 0.0005, -0.0075, -3.4194};
    camera.colour = camera.depth;
    CloudRig rig(holdScene(0.5), camera);
    rig.run(script(camera, kWall), 0.0);
    REQUIRE(countOf(rig.spheres()) == kTarget);
    for (int k = 1; k <= 10; ++k) { // the target is 38 to 44 degrees from the axis
        const Pose aside{{0.0, 0.0, 0.0}, rotationExp({0.0, 0.67 + 0.01 * k, 0.0})};
        rig.run(drawnImage(
                    camera, [](int, int) { return 2.0; }, kGrey),
                k / 30.0, aside);
        CHECK(countOf(rig.spheres(true)) == kTarget);
    }
}

TEST_CASE("A dark colour image takes no held point away from a class that tests colour") {
    constexpr uint32_t kBlack = 0xff060504;
    Scene scene = holdScene(0.5);
    scene.fixtures.push_back(forbiddenClass("near", 0.02)); // depth alone
    scene.fixtures[1].box = Box{{-5.0, -5.0, 0.0}, {5.0, 5.0, 0.55}};
    CloudRig rig(scene, kCamera);
    reference::HoldMemory twin;
    rig.run(script(kCamera, kWall), 0.0);
    twin.step(rig.view(), 0.0, 0.0, rig.forbidden(), rig.points());
    HoldAgreement agreement;
    for (int k = 1; k <= 20; ++k) { // the last five are later than hold_s
        const auto dark = drawnImage(
            kCamera, [](int, int) { return kWall; }, kBlack);
        rig.run(dark, k / 30.0);
        CHECK(countOf(rig.spheres()) == 0);
        if (k != 15) { // at the limit to within the clock's rounding
            CHECK(countOf(rig.spheres(true)) == (k < 15 ? kTarget : 0u));
        }
        const auto expected = twin.step(rig.view(), k / 30.0, (k - 1) / 30.0, rig.forbidden(), rig.points());
        compareHeld(rig.spheres(true), expected, twin.unsure(), agreement);
    }
    CHECK(agreement.wrong == 0);
    CloudRig byDepth(scene, kCamera);
    byDepth.run(script(kCamera, 0.5), 0.0);
    REQUIRE(countOf(byDepth.spheres()) == kTarget);
    byDepth.run(drawnImage(
                    kCamera, [](int, int) { return kWall; }, kBlack),
                0.03);
    CHECK(countOf(byDepth.spheres(true)) == kTarget); // red as well
    scene.fixtures.erase(scene.fixtures.begin());
    CloudRig withoutColour(scene, kCamera);
    withoutColour.run(script(kCamera, 0.5), 0.0);
    REQUIRE(countOf(withoutColour.spheres()) == kTarget);
    withoutColour.run(drawnImage(
                          kCamera, [](int, int) { return kWall; }, kBlack),
                      0.03);
    CHECK(countOf(withoutColour.spheres(true)) == 0);
}

TEST_CASE("The memory's clock wraps at 2^32 us without losing points or keeping them too long") {
    for (const double start : {4294.80, 4294.967, 1.7e9}) {
        CAPTURE(start);
        CloudRig rig(holdScene(0.2), kCamera);
        rig.run(script(kCamera, kWall), start);
        for (int k = 1; k <= 8; ++k) {
            rig.run(script(kCamera, 0.0), start + k / 30.0);
            if (k != 6) { // frame 6 is at the limit to within the clock's rounding
                CHECK(countOf(rig.spheres(true)) == (k < 6 ? kTarget : 0u));
            }
        }
    }
}

TEST_CASE(
    "Held points equal the twin's over noisy sequences with a moving camera, dropouts and an occluder") {
    HoldAgreement a;
    for (const char* name : {"tank", "torus"}) {
        SimulatedCameraOptions options;
        options.width = 161, options.height = 119, options.frames = 14, options.dropShare = 0.2;
        SimulatedCamera camera(*analyticScene(name), options);
        Scene scene = holdScene(0.15);
        scene.fixtures[0].saturation = Band{0.3, 1};
        scene.filter.radius = 1, scene.filter.edge = 0.03, scene.errorBudget = 0.0002;
        scene.fixtures.push_back(forbiddenClass("box", 0.02));
        scene.fixtures[1].box = Box{{-0.2, -0.2, 0.0}, {0.1, 0.1, 2.0}};
        CloudRig rig(scene, camera.info());
        reference::HoldMemory twin;
        double before = 0.0;
        while (const std::optional<Frame> frame = camera.next()) {
            const double now = (*frame)->index / 30.0;
            rig.run(sweptImage(*frame, options.width), now, (*frame)->baseTcamera);
            const auto expected = twin.step(rig.view(), now, before, rig.forbidden(), rig.points());
            compareHeld(rig.spheres(true), expected, twin.unsure(), a);
            before = now;
        }
    }
    CHECK(a.held > 10000);
    CHECK(a.wrong == 0);
    CHECK(a.different < a.held / 1000);
    MESSAGE("hold: ", a.held, " held points, largest error ", a.worst * 1e6, " um, ", a.different,
            " differ, all on a threshold");
}
