// SPDX-License-Identifier: Apache-2.0
// Depths averaged over frames (estimate.comp): against the float64 twin, and what they guarantee on noisy
// surfaces whose true place is known.
#include "engine/reference/estimate.h"
#include "tests/cloud/estimate_worlds.h"

#include <algorithm>
#include <cmath>
#include <doctest/doctest.h>

using namespace fathom;
using namespace fathom::testing;

namespace {

struct EstimateAgreement {
    uint32_t points = 0, averaged = 0, unsure = 0, different = 0, wrong = 0; // wrong: away from thresholds
    double worst = 0.0;                                                      // [m]
};

// Runs one more frame on both rigs and compares the estimates with those that the twin makes of plain points.
void compareEstimates(CloudRig& rig, CloudRig& plain, reference::DepthEstimates& twin, const Image& image,
                      const Pose& pose, const std::optional<Pose>& before, EstimateAgreement& a) {
    rig.run(image, -1.0, pose);
    plain.run(image, -1.0, pose);
    std::vector<uint32_t> masks = plain.masks();
    reference::PointImage points = plain.points();
    const std::vector<uint32_t> patches = rig.listed();
    std::vector<uint8_t> listed;
    for (int i = 0; i < rig.width() * rig.height(); ++i) {
        const auto u = static_cast<uint32_t>(i % rig.width()), v = static_cast<uint32_t>(i / rig.width());
        listed.push_back(patches[slotOfPixel(u, v, rig.layout().across) / 256] != 0 ? 1 : 0);
    }
    twin.step(rig.view(), listed, before, masks, points);
    const std::vector<uint32_t> gotMasks = rig.masks();
    const reference::PointImage got = rig.points();
    for (size_t i = 0; i < masks.size(); ++i) {
        const bool has = got.z[i] != 0.0, due = points.z[i] != 0.0;
        const double apart = has && due ? glm::distance(got.at[i], points.at[i]) : 0.0;
        const bool same = has == due && gotMasks[i] == masks[i] && apart < 1e-6;
        a.points += has, a.averaged += twin.weight(i) > 4, a.unsure += has && twin.unsure()[i] != 0;
        a.different += !same, a.wrong += !same && twin.unsure()[i] == 0;
        a.worst = same ? std::max(a.worst, apart) : a.worst;
    }
}

EstimateAgreement agreementOn(const char* name, SimulatedCameraOptions options, Scene scene) {
    SimulatedCamera camera(*analyticScene(name), options);
    scene.fixtures.push_back(guidanceClass("all"));
    Scene without = scene;
    without.filter.memory = 0;
    CloudRig rig(scene, camera.info()), plain(without, camera.info());
    reference::DepthEstimates twin;
    EstimateAgreement a;
    std::optional<Pose> before;
    while (const std::optional<Frame> frame = camera.next()) {
        const Image image{{(*frame)->depth.begin(), (*frame)->depth.end()},
                          {(*frame)->colour.begin(), (*frame)->colour.end()}};
        compareEstimates(rig, plain, twin, image, *(*frame)->baseTcamera, before, a);
        before = *(*frame)->baseTcamera;
    }
    return a;
}

Scene agreementScene(uint32_t radius) {
    Scene scene = plainScene();
    scene.fixtures[0].saturation = Band{0.3, 1};
    scene.filter.radius = radius, scene.filter.edge = 0.03, scene.filter.memory = 12;
    scene.holdSeconds = 0.15;
    return scene;
}

SimulatedCameraOptions agreementCamera(uint32_t width, uint32_t height, bool motion) {
    SimulatedCameraOptions options;
    options.width = width, options.height = height, options.frames = 16, options.dropShare = 0.1;
    options.metresPerUnit = 0.0001, options.motion = motion;
    return options;
}

} // namespace

TEST_CASE("Estimates equal the twin's on noisy sequences, with a camera that stands still or sways") {
    for (const bool motion : {false, true}) {
        EstimateAgreement sum;
        for (const char* name : {"tank", "torus"}) {
            for (const auto& [width, height] :
                 {std::pair(161u, 119u), std::pair(64u, 48u), std::pair(3u, 5u)}) {
                const EstimateAgreement a = agreementOn(name, agreementCamera(width, height, motion),
                                                        agreementScene(width == 64 ? 0 : 2));
                sum.points += a.points, sum.unsure += a.unsure, sum.averaged += a.averaged,
                    sum.different += a.different;
                sum.wrong += a.wrong, sum.worst = std::max(sum.worst, a.worst);
            }
        }
        CAPTURE(motion);
        CHECK(sum.averaged > sum.points / (motion ? 20 : 4));
        CHECK(sum.unsure < sum.points * 2 / 3);
        CHECK(sum.wrong <=
              (motion ? 4 : 0)); // an unsure pixel spreads to its neighbours when the camera moves
        CHECK(sum.different < sum.points / 100);
        const char* const kind = motion ? "swaying: " : "still: ";
        MESSAGE(kind, sum.points, " points, ", sum.averaged, " averaged over more than 4 frames, ",
                sum.unsure, " near a threshold, largest error ", sum.worst * 1e6, " um, ", sum.different,
                " differ, all on a threshold");
    }
}

TEST_CASE("A still surface gives still points once the estimates have settled") {
    NoisyWorld world(0.4, 1.0, 1);
    CloudRig rig(estimateScene(30), world.camera), plain(estimateScene(0), world.camera);
    std::vector<double> last;
    uint32_t moved = 0, all = 0;
    double error = 0.0, plainError = 0.0;
    for (int k = 0; k < 60; ++k) {
        const Image image = world.next(0.0);
        rig.run(image, -1.0, Pose{}), plain.run(image, -1.0, Pose{});
        const std::vector<double> z = rig.points().z, plainZ = plain.points().z;
        for (size_t i = 0; k >= 40 && i < z.size(); ++i) {
            if (!isInside(rig, i)) {
                continue;
            }
            ++all, moved += z[i] != last[i];
            error += std::pow(z[i] - world.truth[i], 2.0),
                plainError += std::pow(plainZ[i] - world.truth[i], 2.0);
        }
        last = z;
    }
    MESSAGE("still: ", 100.0 * moved / all, " % of the points move per frame; RMS error ",
            1e3 * std::sqrt(error / all), " mm, plain ", 1e3 * std::sqrt(plainError / all), " mm");
    CHECK(moved < all / 8);
    CHECK(error < 0.3 * plainError);
}

TEST_CASE(
    "No estimate is farther from the camera than 1 mm or the plain error, however fast the surface comes") {
    const CameraInfo camera = NoisyWorld(1.0, 0.0, 1).camera;
    CloudRig rig(estimateScene(30), camera), plain(estimateScene(0), camera);
    for (const double range : {0.4, 0.7}) {
        for (const double share : {0.3, 1.0}) { // of the sigma that the program assumes
            for (const double speed : {0.0, 0.006, 0.01, 0.02, 0.03, 0.05, 0.1, 0.4, 1.5}) {
                const Errors e = errorsAt(rig, plain, range, share, -speed);
                CAPTURE(range);
                CAPTURE(share);
                CAPTURE(speed);
                CHECK(e.farther <= std::max(0.001, 1.05 * e.plainFarther));
            }
        }
    }
}

TEST_CASE("A surface that recedes leaves no ghost nearer than 1 mm before the plain points") {
    const CameraInfo camera = NoisyWorld(1.0, 0.0, 1).camera;
    CloudRig rig(estimateScene(30), camera), plain(estimateScene(0), camera);
    for (const double range : {0.4, 0.7}) {
        for (const double share : {0.3, 1.0}) {
            for (const double speed : {0.006, 0.01, 0.02, 0.03, 0.05, 0.1, 0.4, 1.5}) {
                const Errors e = errorsAt(rig, plain, range, share, speed);
                CAPTURE(range);
                CAPTURE(share);
                CAPTURE(speed);
                CHECK(e.nearer <= 0.001 + e.plainNearer);
            }
        }
    }
}

TEST_CASE("What appears in front of a remembered surface has its plain points in its first frame") {
    for (const int edge : {2, 3, 9}) {
        NoisyWorld world(0.5, 0.3, 3);
        CloudRig rig(estimateScene(30), world.camera), plain(estimateScene(0), world.camera);
        for (int k = 0; k < 30; ++k) {
            rig.run(world.next(0.0), -1.0, Pose{});
        }
        Image image = world.next(0.0);
        for (int i = 0; i < edge * edge; ++i) {
            image.depth[static_cast<size_t>((20 + i / edge) * rig.width() + 20 + i % edge)] = 4700;
        }
        rig.run(image, -1.0, Pose{}), plain.run(image, -1.0, Pose{});
        const auto got = rig.points(), due = plain.points();
        for (int i = 0; i < edge * edge; ++i) {
            const auto at = static_cast<size_t>((20 + i / edge) * rig.width() + 20 + i % edge);
            CHECK(got.z[at] == due.z[at]);
            CHECK(due.z[at] < 0.49);
        }
    }
}

TEST_CASE(
    "Estimates start anew after a gap, a jump, and on frames without a pose unless the camera is static") {
    NoisyWorld world(0.5, 0.3, 5);
    Scene isStatic = estimateScene(30);
    isStatic.cameraStatic = true;
    CloudRig rig(estimateScene(30), world.camera), still(isStatic, world.camera),
        plain(estimateScene(0), world.camera);
    const auto isPlain = [&](const CloudRig& r) { return r.points().z == plain.points().z; };
    const auto run = [&](CloudRig& r, double now, const std::optional<Pose>& pose, const Image& image) {
        r.run(image, now, pose), plain.run(image, now, pose);
        return isPlain(r);
    };
    CHECK(run(rig, 0.0, Pose{}, world.next(0.0)));
    CHECK_FALSE(run(rig, 0.03, Pose{}, world.next(0.0)));
    CHECK(run(rig, 0.3, Pose{}, world.next(0.0))); // a gap
    CHECK_FALSE(run(rig, 0.33, Pose{}, world.next(0.0)));
    rig.cycle().forget();
    plain.cycle().forget();
    CHECK(run(rig, 0.36, Pose{}, world.next(0.0)));
    CHECK(run(rig, 0.35, Pose{}, world.next(0.0))); // back in time
    CHECK(run(rig, 0.38, {}, world.next(0.0)));     // no pose
    CHECK(run(rig, 0.41, {}, world.next(0.0)));
    CHECK(run(still, 0.44, {}, world.next(0.0)));
    CHECK_FALSE(run(still, 0.47, {}, world.next(0.0)));
}

TEST_CASE("Without filter.memory, and for cameras without poses, nothing is allocated or dispatched") {
    CameraInfo poseless = pinholeCamera(40, 24);
    poseless.poseless = true;
    Scene isStatic = estimateScene(30);
    isStatic.cameraStatic = true;
    const auto why = [](const Plan& plan) {
        return std::ranges::find(plan.items, std::string("estimate"), &Plan::Item::name)->why;
    };
    CloudRig off(estimateScene(0), pinholeCamera(40, 24)), unknown(estimateScene(30), poseless),
        on(isStatic, poseless);
    CHECK_FALSE(static_cast<bool>(off.cycle().work().estimates));
    CHECK_FALSE(static_cast<bool>(unknown.cycle().work().estimates));
    CHECK(static_cast<bool>(on.cycle().work().estimates));
    CHECK(why(off.plan()) == "filter.memory is 0");
    CHECK(why(unknown.plan()) == "frames have no poses, and camera.static is not set");
    CHECK(why(on.plan()) == "depths averaged over at most 30 frames, static camera");
    CHECK(on.plan().dispatchesPerFrame() == off.plan().dispatchesPerFrame() + 1);
}

TEST_CASE(
    "A forbidden pixel keeps its class while its colour flickers, and loses it when its depth differs") {
    const CameraInfo camera = pinholeCamera(40, 24);
    Scene scene = estimateScene(5);
    scene.fixtures[0].hue = Band{330, 30};
    CloudRig rig(scene, camera);
    const auto wall = [&](double z, uint32_t colour) {
        return drawnImage(
            camera, [&](int, int) { return z; }, colour);
    };
    const auto forbidden = [&](const Image& image) {
        rig.run(image, -1.0, Pose{});
        return std::ranges::count_if(rig.forbidden(), [](int c) { return c >= 0; });
    };
    const auto all = static_cast<std::ptrdiff_t>(camera.depth.pixels());
    CHECK(forbidden(wall(0.6, 0xff2020c0)) == all);
    for (int k = 0; k < 7; ++k) {
        CHECK(forbidden(wall(0.6, 0xff808080)) == 0); // unlisted patches end: nothing of the class is left
    }
    Image mixed = wall(0.6, 0xff2020c0);
    CHECK(forbidden(mixed) == all);
    mixed.colour[500] = 0xff808080;
    for (int k = 0; k < 7; ++k) {
        CHECK(forbidden(mixed) == (k < 5 ? all : all - 1));
    }
    CHECK(forbidden(wall(0.6, 0xff2020c0)) == all);
    mixed.depth[500] = 650;
    CHECK(forbidden(mixed) == all - 1);
}
