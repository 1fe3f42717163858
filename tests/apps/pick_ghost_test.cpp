// SPDX-License-Identifier: Apache-2.0
// The ghost of a picked colour's regions, what they cover, and new names.
#include "apps/operate/fixture_editor.h"
#include "apps/operate/pick_ghost.h"
#include "tests/apps/flat_wall.h"

#include <doctest/doctest.h>

using namespace fathom;
using namespace fathom::operate;

TEST_CASE("The ghost has a sphere of the radius at each selected point, and fewer of very many points") {
    HostFixtures set = flatWall();
    std::vector<uint8_t> selection(set.depth.size(), 0);
    selection[size_t{24} * 64 + 32] = selection[size_t{24} * 64 + 33] = 1;
    const auto two = ghostOf(set, selection, 0.03);
    REQUIRE(two.size() == 2);
    CHECK(two[0].radius == 0.03);
    CHECK(two[0].centre.z == doctest::Approx(1.0));
    CHECK(two[1].centre.x - two[0].centre.x == doctest::Approx(1.0 / 60.0));
    set.depth[size_t{24} * 64 + 33] = 0;
    CHECK(ghostOf(set, selection, 0.03).size() == 1);
    selection.assign(selection.size(), 1);
    const size_t many = ghostOf(set, selection, 0.03).size();
    CHECK(many <= 1500);
    CHECK(many > 300);
    CHECK(ghostOf(set, {}, 0.03).empty());
}

TEST_CASE("A pick that covers the tool or a target says so, with the way that the tool would be pushed") {
    const std::vector<Sphere> ghost{{{0.0, 0.0, 1.0}, 0.04}};
    Scene scene;
    scene.fixtures.resize(2);
    scene.fixtures[1].name = "valve";
    GuidancePose target;
    target.fixture = 1;
    target.present = true;
    target.target.position = {0.0, 0.0, 0.5};
    const std::vector<Sphere> far{{{0.0, 0.0, 0.8}, 0.02}}, inside{{{0.0, 0.0, 0.952}, 0.02}};
    CHECK(coverWarnings(ghost, far, {{target}}, scene).empty());
    CHECK(coverWarnings(ghost, inside, {{target}}, scene) ==
          std::vector<std::string>{"covers the tool: it will be pushed out 12 mm"});
    target.target.position = {0.0, 0.03, 1.0};
    CHECK(coverWarnings(ghost, far, {{target}}, scene) ==
          std::vector<std::string>{"covers the target 'valve'"});
    target.present = false;
    CHECK(coverWarnings(ghost, far, {{target}}, scene).empty());
}

TEST_CASE("A shape to place warns like a pick, a line or an axis never") {
    Scene scene;
    Shape shape{ShapeKind::Sphere, false, {0.05, 0.0, 0.0}, {{0.0, 0.0, 1.0}, {1.0, 0.0, 0.0, 0.0}}, 0};
    const std::vector<Sphere> tool{{{0.0, 0.0, 0.942}, 0.02}};
    CHECK(coverWarnings(shape, tool, {}, scene) ==
          std::vector<std::string>{"covers the tool: it will be pushed out 12 mm"});
    shape.size.x = 0.03;
    CHECK(coverWarnings(shape, tool, {}, scene).empty());
    shape.kind = ShapeKind::Line;
    CHECK(coverWarnings(shape, tool, {}, scene).empty());
}

TEST_CASE("A fixture gets a new name in one undo step, unless the name is empty or taken") {
    Scene scene;
    scene.fixtures.resize(2);
    scene.fixtures[0].name = "red";
    scene.fixtures[1].name = "yellow";
    int changes = 0;
    FixtureEditor editor(scene, [&](const Scene&, const std::vector<Shape>&) { ++changes; });
    CHECK(!editor.unsaved());
    CHECK(editor.rename(0, "yellow") == "not renamed: 'yellow' exists already");
    CHECK(editor.rename(0, "  ") == "not renamed: a name needs a letter or digit");
    CHECK(editor.rename(0, "red").empty());
    CHECK(changes == 0);
    CHECK(editor.rename(0, "main valve").empty());
    CHECK(editor.scene().fixtures[0].name == "main valve");
    CHECK(editor.unsaved());
    CHECK(editor.undo());
    CHECK(editor.scene().fixtures[0].name == "red");
    CHECK(!editor.unsaved());
}
