// SPDX-License-Identifier: Apache-2.0
// Warnings about a tool or an arm that starts on the wrong side of a placed shape.
#include "engine/cycle/start_notes.h"

#include "tests/cycle/haptic_rig.h"
#include "tests/model/urdf_text.h"

#include <doctest/doctest.h>

using namespace fathom;
using namespace fathom::testing;

namespace {

using Notes = std::vector<std::string>;

// A cube with edges of 100 mm around (0, 0, z).
Scene cubeScene(double z, bool keepIn) {
    FixtureClass cube;
    cube.name = "cube";
    cube.shape = ShapeKind::Box;
    cube.keepIn = keepIn;
    cube.baseTshape.position = {0.0, 0.0, z};
    cube.size = dvec3(0.1);
    Scene scene;
    scene.fixtures = {cube};
    return scene;
}

Notes toolNotes(double z, bool keepIn) {
    return startNotes(cubeScene(0.6, keepIn), ballTool(), nullptr, {at(0.0, 0.0, z), {}});
}

} // namespace

TEST_CASE("A tool that starts inside a forbidden shape or outside a keep_in shape is noted with its depth") {
    CHECK(toolNotes(0.6, false) == Notes{"fixture 'cube': the tool starts 60 mm inside of it and is moved "
                                         "out; the hand feels up to the force limit"});
    CHECK(toolNotes(0.45, true) == Notes{"fixture 'cube': the tool starts 110 mm outside of it and is moved "
                                         "in; the hand feels up to the force limit"});
    CHECK(toolNotes(0.45, false).empty());
    CHECK(toolNotes(0.6, true).empty());
    CHECK(toolNotes(0.54005, false).empty()); // in contact, 0.05 mm deep
}

TEST_CASE("A link that starts inside a forbidden shape is noted, unless no joint moves it") {
    const auto urdf = urdfFile(ballLink("a") + ballLink("b") + ballLink("c") +
                               jointText("j", "revolute", "a", "b", "0 0 0.3", "0 1 0") +
                               jointText("k", "revolute", "b", "c", "0 0 0.2", "0 1 0"));
    const auto notesAt = [&](double z, bool keepIn) {
        Scene scene = cubeScene(z, keepIn);
        scene.arm.emplace();
        scene.arm->urdf = urdf.path();
        scene.arm->base = "a";
        scene.arm->tip = "c";
        const auto arm = makeArmSetup(scene, {});
        return startNotes(scene, arm->heldTool(), arm.get(), {{}, arm->startPosture()});
    };
    CHECK(notesAt(0.5, false) == Notes{"fixture 'cube': link c starts 70 mm inside of it and is moved out; "
                                       "the hand feels up to the force limit"});
    CHECK(notesAt(0.0, false).empty()); // link a stays
    CHECK(notesAt(0.9, true).empty());  // does not hold what is outside
}
