// SPDX-License-Identifier: Apache-2.0
// Placed shapes that do not leave an arm alone are named before it runs.
#include "engine/cycle/arm_overlaps.h"

#include "tests/model/urdf_text.h"

#include <doctest/doctest.h>

using namespace fathom;
using namespace fathom::testing;

namespace {

// What is said of a box of this size at this place, and an arm with balls of 20 mm at 0 (base), 0.3 and 0.6 m.
std::vector<std::string> overlapsOf(bool keepIn, const dvec3& size, const dvec3& place) {
    const ScratchFile urdf = urdfFile(ballLink("foot") + ballLink("upper") + ballLink("tip") +
                                      jointText("j1", "revolute", "foot", "upper", "0 0 0.3", "0 1 0") +
                                      jointText("j2", "revolute", "upper", "tip", "0 0 0.3", "0 1 0"));
    Scene scene;
    scene.arm.emplace();
    scene.arm->urdf = urdf.path();
    FixtureClass box;
    box.name = "box";
    box.shape = ShapeKind::Box;
    box.keepIn = keepIn;
    box.size = size;
    box.baseTshape.position = place;
    scene.fixtures = {box};
    return startOverlaps(*makeArmSetup(scene, {}), scene);
}

} // namespace

TEST_CASE("Links that start outside of a keep_in shape are named") {
    CHECK(
        overlapsOf(true, dvec3(0.3), dvec3(0.0, 0.0, 0.6)) ==
        std::vector<std::string>{"fixture 'box': links foot, upper outside of it at the start: keep_in holds "
                                 "all links of the arm, so it pulls them inside, and the hand feels that"});
    CHECK(overlapsOf(true, dvec3(2.0), dvec3(0.0)).empty());
}

TEST_CASE("Links that no joint moves inside of a forbidden shape are named, those that can leave are not") {
    CHECK(
        overlapsOf(false, dvec3(0.2, 0.2, 0.1), dvec3(0.0, 0.0, -0.05)) ==
        std::vector<std::string>{"fixture 'box': link foot inside of it, which no joint moves: the state is "
                                 "escape in all ticks"});
    CHECK(overlapsOf(false, dvec3(0.1), dvec3(0.0, 0.0, 0.6)).empty());
    CHECK(overlapsOf(false, dvec3(0.1), dvec3(1.0, 0.0, 0.0)).empty());
}
