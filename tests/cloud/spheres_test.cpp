// SPDX-License-Identifier: Apache-2.0
// Compares spheres.comp with its float64 twin: centres, radii, classes, forbidden pixels, leaks, order of the
// host copy.
#include "apps/verify/pass_agreement.h"
#include "engine/cloud/frame_params.h"
#include "tests/support/cloud_rig.h"
#include "tests/support/sanitized.h"

#include <algorithm>
#include <doctest/doctest.h>

using namespace fathom;
using namespace fathom::testing;

namespace {

// The host copy has exactly the spheres of the slots, ordered by patch, sub-patch and pixel, and the
// forbidden pixels of the masks.
void checkHost(const CloudRig& rig, const FrameReport& report) {
    const RegionSpheres& host = rig.host().spheres;
    const auto spheres = rig.slotSpheres();
    const auto rows = cloud::classFixtures(rig.scene());
    const auto forbidden = rig.forbidden();
    const auto width = static_cast<uint32_t>(rig.width());
    uint32_t before = 0, wrong = 0;
    for (size_t i = 0; i < host.size(); ++i) {
        const uint32_t source = host.source[i];
        const uint32_t slot = slotOfPixel(source % width, source / width, (width + 15) / 16);
        wrong += i > 0 && slot <= before;
        before = slot;
        const reference::RegionSphere& s = spheres[source];
        wrong += s.radius != host.radius[i] ||
                 glm::distance(s.centre, dvec3(host.x[i], host.y[i], host.z[i]) + rig.origin()) > 1e-10;
        const int cls = s.cls < 0 ? forbidden[source] : s.cls; // with packing the slot has no class
        wrong += cls < 0 || rows[static_cast<size_t>(cls)] != host.fixture[i];
    }
    CHECK(wrong == 0);
    const auto used =
        std::count_if(spheres.begin(), spheres.end(), [](const auto& s) { return s.radius >= 0.0; });
    CHECK(host.size() == static_cast<size_t>(used));
    CHECK(report.counts.spheres == host.size());
    const std::vector<uint32_t> masks = rig.masks();
    uint32_t marked = 0, wrongBits = 0;
    const PatchBits onDevice = rig.set().forbidden(rig.layout());
    for (uint32_t i = 0; i < masks.size(); ++i) {
        const bool is = reference::forbiddenClass(rig.scene(), masks[i]) >= 0;
        marked += is;
        wrongBits += is != rig.host().forbiddenAt(i % width, i / width);
        wrongBits += is != onDevice.at(i % width, i / width);
    }
    CHECK(wrongBits == 0);
    CHECK(report.counts.forbidden == marked);
}

// A tree requires slots in addition to packed runs.
void withSlots(Plan& plan) {
    plan.tree = plan.pack;
}

} // namespace

TEST_CASE("Sphere centres and radii are within 1 um of the twin's, and classes and forbidden pixels are "
          "equal, for every size") {
    verify::SphereAgreement all;
    for (const CloudCase& c : cloudCases()) {
        CAPTURE(c.name);
        CloudRig rig(c.scene, c.camera, withSlots);
        const FrameReport report = rig.run(c.image);
        const verify::SphereAgreement a = verify::sphereAgreement(rig);
        CHECK(a.wrong == 0);
        CHECK(a.centre < 1e-6);
        CHECK(a.radius < 1e-6);
        checkHost(rig, report);
        all.spheres += a.spheres, all.centre = std::max(all.centre, a.centre),
                                  all.radius = std::max(all.radius, a.radius);
    }
    CHECK(all.spheres > (kSanitized ? 10000 : 100000));
    MESSAGE("spheres: largest error of a centre ", all.centre * 1e6, " um, of a radius ", all.radius * 1e6,
            " um over ", all.spheres);
}

TEST_CASE("Of several forbidden classes the largest radius wins, then file order; guidance is counted "
          "independently") {
    const CameraInfo camera = pinholeCamera(64, 48);
    Scene scene = plainScene();
    scene.registrationSigma = 0.002;
    const auto boxed = [](FixtureClass f, double x0, double x1) {
        f.box = Box{{x0, -9, 0}, {x1, 9, 9}};
        return f;
    };
    // A placed shape is not a point class, so mask bits and file rows differ.
    scene.fixtures = {forbiddenClass("shape", 0.5), boxed(forbiddenClass("small", 0.01), -9, 9),
                      boxed(guidanceClass("goal"), -9, 9), boxed(forbiddenClass("first", 0.03), -9, 0),
                      boxed(forbiddenClass("second", 0.03), -0.1, 9)};
    scene.fixtures[0].shape = ShapeKind::Sphere;
    CloudRig rig(scene, camera, withSlots);
    const FrameReport report = rig.run(drawnImage(camera, [](int, int) { return 0.7; }));
    CHECK(report.counts.classPixels ==
          std::vector<uint32_t>{3072, 3072, report.counts.classPixels[2], report.counts.classPixels[3]});
    CHECK(report.counts.forbidden == 3072);
    CHECK(report.counts.spheres == 3072);
    CHECK(report.guidanceCount == 3072);
    CHECK(rig.host().guidance[0].count == 3072);
    CHECK(rig.host().guidance[0].fixture == 2);
    checkHost(rig, report);
    for (const reference::RegionSphere& s : rig.spheres()) {
        CHECK(s.cls == (s.centre.x <= 0.0 ? 2 : 3)); // "first" where both apply
        CHECK(s.radius == doctest::Approx(0.036).epsilon(1e-6));
    }
    CHECK(verify::sphereAgreement(rig).wrong == 0);
}

TEST_CASE("A class with a smaller radius wins only where it is alone, for 1 to 8 classes") {
    const CameraInfo camera = freiburgCamera(77, 45);
    for (uint32_t count = 1; count <= 8; ++count) {
        CAPTURE(count);
        CloudRig rig(classesScene(count), camera, withSlots);
        const FrameReport report = rig.run(stressImage(camera, 40 + count));
        CHECK(verify::sphereAgreement(rig).wrong == 0);
        checkHost(rig, report);
        CHECK(report.counts.classPixels.size() == count);
        CHECK(report.counts.classSpheres.size() == count);
    }
}

TEST_CASE("Leaks are reported with the largest spacing and range of the class, and not where spheres touch") {
    const CameraInfo camera = pinholeCamera(128, 64);
    Scene scene = plainScene();
    scene.fixtures = {forbiddenClass("tight", 0.0015), forbiddenClass("wide", 0.03)};
    scene.fixtures[0].box = Box{{-9, -9, 0}, {9, 0, 9}};
    scene.fixtures[1].box = Box{{-9, 0.0001, 0}, {9, 9, 9}};
    CloudRig rig(scene, camera);
    const FrameReport report =
        rig.run(drawnImage(camera, [](int u, int v) { return v < 20 && u > 60 && u < 63 ? 2.0 : 0.4; }));
    const reference::Leaks twin =
        reference::leaks(scene, rig.width(), rig.height(), rig.forbidden(), rig.points());
    CHECK(twin.spacing[0] > 0.0015);
    CHECK(twin.spacing[1] == 0.0);
    for (size_t c = 0; c < 2; ++c) {
        CHECK(report.counts.leakSpacing[c] == doctest::Approx(twin.spacing[c]).epsilon(1e-6));
        CHECK(report.counts.leakRange[c] == doctest::Approx(twin.range[c]).epsilon(1e-6));
    }
    Scene coarse = classesScene(8);
    CloudRig stress(coarse, camera);
    const FrameReport rough = stress.run(stressImage(camera, 77));
    const reference::Leaks rougher =
        reference::leaks(coarse, stress.width(), stress.height(), stress.forbidden(), stress.points());
    for (size_t c = 0; c < 8; ++c) {
        CAPTURE(c);
        CHECK(rough.counts.leakSpacing[c] == doctest::Approx(rougher.spacing[c]).epsilon(1e-5));
        CHECK(rough.counts.leakRange[c] == doctest::Approx(rougher.range[c]).epsilon(1e-5));
    }
}

TEST_CASE("Frames of 1920x1080 and 3840x2160 with every pixel selected count every pixel") {
    for (const auto& [width, height] : {std::pair{1920u, 1080u}, {3840u, 2160u}}) {
        const CameraInfo camera = pinholeCamera(width, height, 0.0001);
        Scene scene = plainScene();
        scene.errorBudget = width == 3840 ? 0.0005 : 0.0;
        CloudRig rig(scene, camera, {}, 0);
        const FrameReport report =
            rig.run(drawnImage(camera, [](int u, int v) { return 0.5 + 0.00005 * u + 0.0001 * v; }));
        const uint32_t pixels = width * height;
        CHECK(report.counts.valid == pixels);
        CHECK(report.counts.forbidden == pixels);
        CHECK(report.counts.classPixels[0] == pixels);
        CHECK(report.counts.patches == rig.cycle().layout().patches());
        CHECK(report.counts.nodes ==
              rig.cycle().layout().nodes() - (height % 16 == 8 ? rig.cycle().layout().across * 8 : 0));
        if (width == 1920) {
            CHECK(report.counts.spheres == pixels);
        } else {
            CHECK(report.counts.spheres < pixels / 2);
            CHECK(report.counts.spheres > pixels / 17);
        }
        CHECK(rig.host().spheres.size() == report.counts.spheres);
    }
}
