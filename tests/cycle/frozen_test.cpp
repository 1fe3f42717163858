// SPDX-License-Identifier: Apache-2.0
// Frozen classes keep their spheres while the others follow the frame.
#include "tests/cycle/red_and_blue.h"

#include <doctest/doctest.h>
#include <set>

using namespace fathom;
using namespace fathom::testing;

namespace {

// Smallest and largest z [m] of the spheres of a scene row.
std::pair<double, double> depths(const HostFixtures& set, uint8_t row) {
    std::pair<double, double> span{1e9, -1e9};
    for (size_t i = 0; i < set.spheres.size(); ++i) {
        if (set.spheres.fixture[i] == row) {
            const double z = set.origin.z + double{set.spheres.z[i]};
            span = {std::min(span.first, z), std::max(span.second, z)};
        }
    }
    return span;
}

} // namespace

TEST_CASE(
    "A frozen class keeps its spheres while another follows the frame, and follows again when released") {
    const CameraInfo camera = pinholeCamera(100, 60);
    Scene scene = redAndBlueScene();
    CloudRig rig(scene, camera);
    rig.run(redAndBlueImage(camera, 1.0, 1.0));
    const size_t all = rig.host().spheres.size();
    scene.fixtures[0].frozen = true;
    rig.cycle().setScene(scene);
    for (double z : {1.0, 1.1, 1.3}) {
        rig.run(redAndBlueImage(camera, z, z));
        CAPTURE(z);
        CHECK(depths(rig.host(), 0).first == doctest::Approx(1.0).epsilon(1e-5));
        CHECK(depths(rig.host(), 0).second == doctest::Approx(1.0).epsilon(1e-5));
        CHECK(depths(rig.host(), 1).first == doctest::Approx(z).epsilon(1e-5));
        CHECK(rig.host().spheres.size() == all);
        CHECK(rig.set().grid.get().size() == all);
        const auto& sources = rig.host().spheres.source;
        CHECK(std::set<uint32_t>(sources.begin(), sources.end()).size() == all);
    }
    scene.fixtures[0].frozen = false;
    rig.cycle().setScene(scene);
    rig.run(redAndBlueImage(camera, 1.3, 1.3));
    CHECK(depths(rig.host(), 0).first == doctest::Approx(1.3).epsilon(1e-5));
}

TEST_CASE("A frozen guidance class keeps its target") {
    const CameraInfo camera = pinholeCamera(100, 60);
    Scene scene = redAndBlueScene();
    scene.fixtures[1].role = Role::Guidance;
    CloudRig rig(scene, camera);
    rig.run(redAndBlueImage(camera, 1.0, 1.0));
    scene.fixtures[1].frozen = true;
    rig.cycle().setScene(scene);
    rig.run(redAndBlueImage(camera, 1.0, 1.0));
    rig.run(redAndBlueImage(camera, 1.4, 1.4));
    REQUIRE(rig.host().guidance.size() == 1);
    CHECK(rig.host().guidance[0].position.z == doctest::Approx(1.0).epsilon(1e-4));
}

TEST_CASE("A frozen class keeps its place to the last bit while the camera is far away and when it is back") {
    const CameraInfo camera = pinholeCamera(100, 60);
    Scene scene = redAndBlueScene();
    CloudRig rig(scene, camera);
    const Image image = redAndBlueImage(camera, 1.0, 1.0);
    rig.run(image);
    scene.fixtures[0].frozen = true;
    rig.cycle().setScene(scene);
    rig.run(image);
    const RegionSpheres here = rig.host().spheres;
    for (const double away : {5e5, 2000.0, 0.0}) {
        scene.baseTcamera.position.x = away;
        rig.cycle().setScene(scene);
        rig.run(image);
        CAPTURE(away);
        CHECK(rig.host().origin.x == away);
        CHECK(rig.host().spheres.size() == here.size());
        CHECK(depths(rig.host(), 0).first == doctest::Approx(1.0).epsilon(1e-5));
        const size_t last = here.size() - 1; // of the frozen class
        CHECK(rig.host().spheres.x[last] + away == doctest::Approx(here.x[last]).epsilon(1e-3));
    }
    CHECK(rig.host().spheres.x == here.x);
    CHECK(rig.host().spheres.source == here.source);
}
