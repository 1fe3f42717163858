// SPDX-License-Identifier: Apache-2.0
// Joint limits and speeds that a scene sets instead of the URDF's.
#include "engine/cycle/arm_setup.h"

#include "tests/model/urdf_text.h"

#include <doctest/doctest.h>

using namespace fathom;
using namespace fathom::testing;

namespace {

// The rig of the scene's arm, which has one joint of the type, with limits -2 to 2.
std::unique_ptr<ArmSetup> rigOf(Scene& scene, const std::string& type) {
    const auto urdf =
        std::filesystem::temp_directory_path() / ("fathom_joints_" + std::to_string(::getpid()) + ".urdf");
    std::ofstream(urdf) << "<robot name='r'>" + ballLink("a") + ballLink("b") +
                               jointText("j", type, "a", "b", "0 0 0.3", "0 1 0") + "</robot>";
    scene.arm->urdf = urdf;
    std::unique_ptr<ArmSetup> rig = makeArmSetup(scene, {});
    std::filesystem::remove(urdf);
    return rig;
}

// Notes on that arm, whose joint the scene overrides.
std::vector<std::string> notesOn(const SceneArm::Joint& joint, const std::string& type = "revolute") {
    Scene scene;
    scene.arm.emplace();
    scene.arm->joints = {joint};
    return rigOf(scene, type)->model.notes;
}

} // namespace

TEST_CASE("Limits and speeds of the scene that look like degrees or millimetres are questioned") {
    using Notes = std::vector<std::string>;
    const std::string wider = "joint j: the scene's limits -90 to 90 are wider than the file's, -2 to 2";
    CHECK(notesOn({"j", -90.0, 90.0, {}, {}}) ==
          Notes{"joint j: limits -90 to 90 rad span more than four turns; in degrees?", wider});
    CHECK(notesOn({"j", -90.0, 90.0, {}, {}}, "prismatic") ==
          Notes{"joint j: limits -90 to 90 m span more than 5 m; in millimetres, or without limits?", wider});
    CHECK(notesOn({"j", {}, {}, 180.0, {}}) == Notes{"joint j: speed 180 rad/s; in degrees per second?"});
    CHECK(notesOn({"j", -1.0, 1.0, 1.0, {}}).empty());
    CHECK(notesOn({"j", 0.5, 0.5, {}, {}}) == Notes{"joint j: limits 0.5 to 0.5 rad: it cannot move"});
    CHECK(notesOn({"j", -3.0, 3.0, {}, {}}, "continuous").empty());
}

TEST_CASE("The self-filter of an arm adds three sigma of the registration, and a grasp takes its seconds") {
    Scene scene;
    scene.arm.emplace();
    scene.registrationSigma = 0.004;
    scene.haptics.rateHz = 500.0;
    scene.arm->grasp.seconds = 4.0;
    CHECK(rigOf(scene, "revolute")->padding == 0.0); // no self-filter
    scene.arm->selfFilter = 0.01;
    const auto rig = rigOf(scene, "revolute");
    CHECK(rig->padding == doctest::Approx(0.01 + 3.0 * 0.004));
    CHECK(rig->proxy.graspPerTick == doctest::Approx(1.0 / (4.0 * 500.0)));
    CHECK(rig->proxy.period == doctest::Approx(0.002));
}
