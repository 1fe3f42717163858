// SPDX-License-Identifier: Apache-2.0
// Values that a pilot types or drags in the tab Fixtures, and edits that the editor refuses.
#include "apps/session/session.h"
#include "tests/apps/laid_screen.h"

#include <doctest/doctest.h>
#include <limits>

using namespace fathom;
using namespace fathom::operate;

namespace {

void holdControl(bool on) {
#if IMGUI_VERSION_NUM < 18700
    ImGui::GetIO().KeyCtrl = on;
#else
    ImGui::GetIO().AddKeyEvent(ImGuiMod_Ctrl, on);
#endif
}

// The tab Fixtures under the mouse.
struct FixturesTab {
    testing::LaidScreen laid;

    FixturesTab() {
        laid.run.console.panels.tab = Tab::Fixtures;
        laid.loadFontsFor({1600, 1000}, 1.0);
        laid.draw();
    }
    void press(ImVec2 at) {
        ImGuiIO& io = ImGui::GetIO();
        io.MousePos = at;
        laid.draw(2);
        io.MouseDown[0] = true;
        laid.draw(2);
    }
    void release() {
        ImGui::GetIO().MouseDown[0] = false;
        laid.draw(2);
    }
    ImVec2 in(const std::string& name, float share) const {
        const auto place = laid.run.console.places.at(name);
        return {place[0] + share * place[2], place[1] + 0.5f * place[3]};
    }
    // Ctrl and click, the keys of a number, then a click elsewhere.
    void type(const std::string& name, const char* number) {
        holdControl(true);
        press(in(name, 0.1f));
        release();
        holdControl(false);
        laid.draw(2);
        ImGui::GetIO().AddInputCharactersUTF8(number);
        laid.draw(2);
        press({1.0f, 1.0f});
        release();
    }
    void drag(const std::string& name, float from, float to) {
        press(in(name, from));
        ImGui::GetIO().MousePos = in(name, to);
        laid.draw(2);
        release();
    }
    Pick& pickOf(const Band& saturation) {
        Pick& pick = laid.run.console.pick;
        pick.active = pick.taken = true;
        pick.gates.name = "picked 1";
        pick.gates.hue = Band{350.0, 10.0};
        pick.gates.saturation = saturation;
        laid.draw();
        return pick;
    }
};

// A scene with as many classes of points as asked, and one box.
Scene sceneWith(int classes) {
    Scene scene;
    scene.fixtures.resize(static_cast<size_t>(classes));
    for (int i = 0; i < classes; ++i) {
        scene.fixtures[static_cast<size_t>(i)].name = "class " + std::to_string(i);
    }
    FixtureClass box;
    box.name = "box";
    box.shape = ShapeKind::Box;
    box.size = dvec3(0.1);
    scene.fixtures.push_back(box);
    return withSpareClasses(scene);
}

std::string add(FixtureEditor& editor) {
    Console console;
    console.pick.taken = true;
    return editor.takePicked(console);
}

} // namespace

TEST_CASE("A number typed into a slider of a fixture stays within the range of the slider") {
    FixturesTab tab;
    const auto radius = [&] { return tab.laid.editor.scene().fixtures[0].radius; };
    tab.type("radius red valve", "35");
    CHECK(radius() == doctest::Approx(0.035));
    tab.type("radius red valve", "-20");
    CHECK(radius() == doctest::Approx(0.002));
    tab.type("radius red valve", "99999");
    CHECK(radius() == doctest::Approx(0.150));
    const Pick& pick = tab.pickOf({0.2, 0.9});
    tab.type("pick radius", "-20");
    CHECK(pick.gates.radius == doctest::Approx(0.002));
    tab.type("pick saturation", "-7");
    CHECK(pick.gates.saturation->lo == 0.0);
}

TEST_CASE("An end of a band pushes the other one, except where hues pass through 360 degrees") {
    FixturesTab tab;
    const Pick& pick = tab.pickOf({0.1, 0.4});
    tab.drag("pick saturation", 0.04f, 0.3f); // beyond the other end
    CHECK(pick.gates.saturation->lo > 0.5);
    CHECK(pick.gates.saturation->hi == pick.gates.saturation->lo);
    tab.type("pick hue", "300");
    CHECK(pick.gates.hue->lo == 300.0);
    CHECK(pick.gates.hue->hi == 10.0);
}

TEST_CASE(
    "The editor refuses fixtures that no scene file could contain, in one line, and keeps the old ones") {
    int changes = 0;
    FixtureEditor editor(sceneWith(1), [&](const Scene&, const std::vector<Shape>&) { ++changes; });
    const FixtureClass points = editor.scene().fixtures[0], box = editor.scene().fixtures.back();
    const size_t last = editor.scene().fixtures.size() - 1;
    FixtureClass bad = points;
    bad.radius = -0.02;
    CHECK(editor.change(0, bad).find("fixtures[0].radius: -0.02 (allowed: a number from 0.0001 to 10)") !=
          std::string::npos);
    bad = points;
    bad.saturation = Band{0.9, 0.1};
    CHECK(editor.change(0, bad).find("not changed: ") == 0);
    bad = points;
    bad.radius = std::numeric_limits<double>::quiet_NaN();
    CHECK(editor.change(0, bad).find("radius") != std::string::npos);
    bad = box;
    bad.size.y = 0.0;
    CHECK(editor.change(last, bad).find("size") != std::string::npos);
    bad.name = "another box";
    CHECK(editor.place(bad).find("not placed: ") == 0);
    CHECK(editor.scene().fixtures.size() == last + 1);
    CHECK(editor.scene().fixtures[0].radius == points.radius);
    CHECK(changes == 0);
    CHECK_FALSE(editor.undo());
    bad.size.y = 0.2;
    CHECK(editor.place(bad) == "");
    CHECK(changes == 1);
}

TEST_CASE("A third new class is refused with the way to get it, a ninth with the limit") {
    const auto none = [](const Scene&, const std::vector<Shape>&) {};
    FixtureEditor few(sceneWith(1), none), many(sceneWith(7), none);
    CHECK(add(few) == "");
    CHECK(add(few) == "");
    CHECK(add(few) == "not added: two new classes per run; save (Ctrl S) and open the scene again for more");
    few.remove(0);
    CHECK(add(few) == "");
    CHECK(add(many) == "");
    CHECK(add(many) == "not added: at most 8 classes of points");
}

TEST_CASE("In the image of a camera without colour nothing is picked or selected") {
    testing::LaidScreen laid;
    Console console;
    laid.editor.pickAt(console, laid.run.view.scene(), {3, 3});
    CHECK_FALSE(console.pick.taken);
    console.pick.taken = true;
    laid.editor.preview(console, laid.run.view.scene());
    CHECK(laid.editor.selection().empty());
}
