// SPDX-License-Identifier: Apache-2.0
// Notes on settings that leave a hand without force, though nothing is wrong by the rules of the scene file.
#include "engine/cycle/haptic_notes.h"
#include "tests/cycle/haptic_rig.h"

#include <doctest/doctest.h>

using namespace fathom;
using namespace fathom::testing;

namespace {

Scene paperScene(std::optional<double> stiffness, const char* device = "ideal") {
    Scene scene = handScene(device);
    FixtureClass goal;
    goal.role = Role::Guidance;
    scene.fixtures.push_back(goal);
    scene.haptics.guidance = Scene::Haptics::GuidanceMode::Paper;
    scene.haptics.stiffness = stiffness;
    return scene;
}

bool notes(const Scene& scene, const std::string& part) {
    for (const std::string& note : hapticNotes(scene)) {
        if (note.find(part) != std::string::npos) {
            return true;
        }
    }
    return false;
}

bool warns(const Scene& scene, const std::string& part) {
    for (const std::string& warning : forceWarnings(scene)) {
        if (warning.find(part) != std::string::npos) {
            return notes(scene, part);
        }
    }
    return false;
}

} // namespace

TEST_CASE("Damping that ticks cannot follow on a light device is named where the device's own is unknown") {
    Scene scene = handScene("touch");
    const std::string part = "haptics.damping: ";
    for (const double damping : {0.0, 10.0, 19.9}) {
        scene.haptics.damping = damping;
        CHECK(forceWarnings(scene).empty());
    }
    scene.haptics.damping = 100.0;
    CHECK(warns(scene, part + "100 N s/m at the hand, over the 20 N s/m that are safe at this rate_hz"));
    scene.haptics.damping = 10.0;
    scene.haptics.delay = 1; // a third of it
    CHECK(warns(scene, part));
    scene.haptics.delay = 0;
    scene.haptics.lowpassHz = 10.0; // lags, but makes damping safer
    CHECK_FALSE(warns(scene, part));
    scene.haptics.lowpassHz = 0.0;
    scene.hand.scale = 3.0; // the hand feels three times as much
    CHECK(warns(scene, part));
}

TEST_CASE("A stiffness that leaves the pull of guidance no spring is named with the one that does") {
    const std::string part = "haptics.guidance: paper pulls with a spring of ";
    for (const double stiffness : {479.0, 480.0, 1000.0}) {
        CAPTURE(stiffness);
        CHECK(warns(paperScene(stiffness), part));
    }
    CHECK(warns(paperScene(1000.0), part + "0 N/m: haptics.stiffness, 1000 N/m, leaves no more; auto takes "
                                           "384 N/m and leaves 96 N/m"));
    CHECK(warns(paperScene(3000.0, "falcon"), part));
    for (const std::optional<double> stiffness : {std::optional<double>(), {20.0}, {400.0}, {450.0}}) {
        CHECK(forceWarnings(paperScene(stiffness)).empty());
    }
    Scene target = paperScene(1000.0);
    target.haptics.guidance = Scene::Haptics::GuidanceMode::Target;
    CHECK(forceWarnings(target).empty());
    Scene none = paperScene(1000.0);
    none.fixtures.clear();
    CHECK(forceWarnings(none).empty());
}

TEST_CASE("Limits and springs below what a hand feels are named") {
    Scene scene = handScene();
    scene.haptics.forceLimit = 1e-9;
    CHECK(warns(scene, "haptics.limits.force: 1e-09 N, less than a hand feels (0.05 N)"));
    scene.haptics.forceLimit = 0.1;
    CHECK(forceWarnings(scene).empty());
    scene.haptics.torqueLimit = 0.0;
    CHECK(notes(scene, "haptics.limits.torque: 0 N m, less than a hand feels (0.001 N m)"));
    CHECK(forceWarnings(scene).empty()); // a hand may want forces alone
    scene.haptics.torqueLimit = 0.2;
    CHECK(hapticNotes(scene).empty());
    scene.haptics.slewForce = 0.1;
    CHECK(warns(scene, "haptics.limits.slew_N_per_s: 0.1 N/s: a force of 1 N takes 10 s"));
    scene.haptics.slewForce = 2000.0;
    scene.haptics.slewTorque = 0.001;
    CHECK(notes(scene, "haptics.limits.slew_Nm_per_s: 0.001 N m/s: a torque of 0.01 N m takes 10 s"));
    scene.haptics = handScene().haptics;
    scene.haptics.stiffness = 0.001;
    CHECK(warns(scene, "haptics.stiffness: 0.001 N/m at the hand: 10 mm inside a region it feels 1e-05 N"));
    scene.haptics.stiffness = 10.0;
    CHECK(forceWarnings(scene).empty());
    scene.hand.scale = 0.1;
    CHECK(warns(scene, "haptics.stiffness: 1 N/m at the hand"));
}

TEST_CASE("A pilot's limits below what a hand feels are named before that pilot is chosen") {
    Scene scene = handScene();
    Scene::Pilot anna, ben;
    anna.name = "anna";
    ben.name = "ben";
    ben.haptics.forceLimit = 0.0;
    scene.pilots = {anna, ben};
    scene.choosePilot("anna");
    CHECK(notes(scene, std::string("pilots: ben: ") + kNoForce));
    CHECK(forceWarnings(scene).empty());
    scene.choosePilot("ben");
    CHECK(warns(scene, kNoForce));
}
