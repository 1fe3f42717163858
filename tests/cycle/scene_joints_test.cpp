// SPDX-License-Identifier: Apache-2.0
// Joint limits and speeds that a scene sets instead of the URDF's.
#include "engine/cycle/arm_setup.h"

#include "tests/model/urdf_text.h"

#include <algorithm>
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

namespace {

const std::string kFinger = "<limit lower='0.0013' upper='0.0133' velocity='0.003' effort='1'/>";

// Base ball a, ball b on a joint, and a sliding finger d that e follows thirty times as far.
std::unique_ptr<ArmSetup> gripperRig(Scene& scene, const std::string& finger = kFinger) {
    const auto urdf = urdfFile(ballLink("a") + ballLink("b") + ballLink("d") + ballLink("e") +
                               jointText("j", "revolute", "a", "b", "0 0 0.3", "0 1 0") +
                               jointText("slide", "prismatic", "b", "d", "0 0 0.1", "0 0 1", finger) +
                               jointText("turn", "revolute", "b", "e", "0 0 0.1", "0 1 0",
                                         "<limit lower='-1' upper='1' velocity='1' effort='1'/>" +
                                             mimicText("slide", "multiplier='30'")));
    scene.arm->urdf = urdf.path();
    scene.arm->tip = "b";
    scene.arm->grasp.fingers = {{"slide", 0.0133, 0.0013}};
    return makeArmSetup(scene, {});
}

bool hasNote(const ArmSetup& setup, const std::string& note) {
    return std::ranges::count(setup.model.notes, note) == 1;
}

} // namespace

TEST_CASE("The slowest finger sets the time of a grasp, with a note") {
    Scene scene;
    scene.haptics.rateHz = 1000.0;
    scene.arm.emplace();
    scene.arm->grasp.seconds = 0.1;
    const auto slow = gripperRig(scene);
    CHECK(slow->proxy.graspPerTick == doctest::Approx(0.001 / 4.0));
    CHECK(hasNote(*slow, "finger slide: 0.003 m/s of the file make the grasp take 4 s instead of 0.1 s"));
    const auto follower = gripperRig(scene, "<limit lower='0.0013' upper='0.0133' velocity='1' effort='1'/>");
    CHECK(follower->proxy.graspPerTick == doctest::Approx(0.001 / 0.36));
    CHECK(hasNote(*follower, "finger turn: 1 rad/s of the file make the grasp take 0.36 s instead of 0.1 s"));
    scene.arm->grasp.seconds = 5.0;
    const auto fits = gripperRig(scene);
    CHECK(fits->proxy.graspPerTick == doctest::Approx(0.001 / 5.0));
    for (const std::string& note : fits->model.notes) {
        CHECK(note.find("grasp take") == std::string::npos);
    }
}

TEST_CASE("A follower off the chain binds the speed of the joint that it follows") {
    Scene scene;
    scene.arm.emplace();
    const auto urdf = urdfFile(ballLink("a") + ballLink("b") + ballLink("c") +
                               jointText("j", "revolute", "a", "b", "0 0 0.3", "0 1 0") +
                               jointText("crank", "revolute", "a", "c", "0 0 0.1", "0 1 0",
                                         "<limit lower='-9' upper='9' velocity='0.2' effort='1'/>" +
                                             mimicText("j", "multiplier='-4'")));
    scene.arm->urdf = urdf.path();
    scene.arm->tip = "b";
    const auto rig = makeArmSetup(scene, {});
    CHECK(rig->model.joints.at(0).speed == doctest::Approx(0.05));
    CHECK(rig->model.joints.at(0).speedFrom == "mimic joint crank");
}

TEST_CASE("Notes say which links a keep_in shape holds, and which ones are in a forbidden shape") {
    Scene scene;
    scene.arm.emplace();
    FixtureClass room;
    room.name = "room";
    room.shape = ShapeKind::Box;
    room.keepIn = true;
    room.baseTshape.position = {0.0, 0.0, 0.4};
    room.size = {0.3, 0.3, 0.3};
    FixtureClass bench = room;
    bench.name = "bench";
    bench.keepIn = false;
    bench.baseTshape.position = {0.0, 0.0, -0.04};
    bench.size = {0.5, 0.5, 0.1};
    scene.fixtures = {room, bench};
    const auto rig = gripperRig(scene);
    CHECK(hasNote(*rig, "fixture 'room': keeps links b, d, e inside; not a, outside of it at the start"));
    CHECK(hasNote(*rig, "fixture 'bench': link a is inside of it, and no joint moves that link: it stays"));
    scene.fixtures[0].baseTshape.position = {0.0, 0.0, 9.0};
    CHECK(hasNote(*gripperRig(scene),
                  "fixture 'room': keeps no link inside, because all are outside of it at "
                  "the start"));
    scene.fixtures[0].baseTshape.position = {0.0, 0.0, 0.0};
    scene.fixtures[0].size = {9.0, 9.0, 9.0};
    scene.fixtures.pop_back();
    const auto whole = gripperRig(scene);
    for (const std::string& note : whole->model.notes) {
        CHECK(note.find("fixture") == std::string::npos);
    }
}

TEST_CASE("A start that a mimic joint's limits do not allow is rejected with that joint") {
    const auto urdf = urdfFile(ballLink("a") + ballLink("b") + ballLink("c") +
                               jointText("j", "revolute", "a", "b", "0 0 0.3", "0 1 0") +
                               jointText("follower", "revolute", "b", "c", "0 0 0.3", "0 1 0",
                                         "<limit lower='-9' upper='9' velocity='1' effort='1'/>" +
                                             mimicText("j", "multiplier='3'")));
    const auto startAt = [&](double start) {
        Scene scene;
        scene.arm.emplace();
        scene.arm->urdf = urdf.path();
        scene.arm->base = "a";
        scene.arm->tip = "c";
        scene.arm->joints = {{"j", {}, {}, {}, start}, {"follower", -0.9, 0.9, {}, {}}};
        return makeArmSetup(scene, {})->start[0];
    };
    CHECK(startAt(0.3) == doctest::Approx(0.3)); // at the limit
    CHECK(startAt(0.300001) <= 0.3 + 1e-12);     // as six digits may print it
    CHECK(refusalOf([&] { startAt(1.5); }) ==
          ": arm.joints[0].start: 1.5 (allowed: -0.3 to 0.3, the limits of mimic joint follower)");
}
