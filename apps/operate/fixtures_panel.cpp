// SPDX-License-Identifier: Apache-2.0
// The fixtures panel: existing fixtures, the preview of a picked colour, shapes to place.
#include "apps/binding/scene_edits.h"
#include "apps/operate/fixture_editor.h"
#include "apps/operate/holding_panel.h"
#include "apps/operate/keys.h"
#include "apps/operate/pick_panel.h"
#include "apps/operate/theme.h"

#include <GLFW/glfw3.h>
#include <algorithm>

namespace fathom::operate {

namespace {

// Slider for a radius or size [m]; true when it is released at a new value. Also a typed value stays within
// its range, which includes what the scene file has. id: unique among all sliders.
bool sizeSlider(Console& console, double& size, const char* word, const std::string& place, int id) {
    Console::Editing& editing = console.editing;
    float millimetres = static_cast<float>(1e3 * size);
    const float least = std::min(2.0f, millimetres), most = std::max(150.0f, millimetres);
    const bool dragged = editing.slider == id;
    millimetres = dragged ? editing.millimetres : millimetres;
    ImGui::SetNextItemWidth(-1.0f);
    ImGui::PushID(id);
    if (ImGui::SliderFloat("##size", &millimetres, least, most, (std::string(word) + " %.0f mm").c_str(),
                           ImGuiSliderFlags_AlwaysClamp)) {
        editing.slider = id;
        editing.millimetres = millimetres;
    }
    ImGui::PopID();
    markPlace(console, place);
    explain(console,
            "Drag, or Ctrl and click to type millimetres. It applies when released; Ctrl Z takes it back");
    const bool done = ImGui::IsItemDeactivatedAfterEdit();
    if (done) {
        size = 1e-3 * static_cast<double>(millimetres);
    }
    if (!ImGui::IsItemActive() && dragged) {
        editing.slider = -1;
    }
    return done;
}

// Radius of a class of points, or the sizes of a shape: three edges of a box, radius and height of a
// cylinder.
bool sizes(Console& console, FixtureClass& now, int row) {
    if (now.isPoints()) {
        return now.role == Role::Forbidden &&
               sizeSlider(console, now.radius, "radius", "radius " + now.name, 4 * row);
    }
    constexpr const char* kBox[] = {"x", "y", "z"};
    constexpr const char* kOther[] = {"size", "height", ""};
    bool done = false;
    for (int k = 0; k < 3; ++k) {
        const bool box = now.shape == ShapeKind::Box;
        if (now.size[k] > 0.0 && (box || k < 2)) {
            done = sizeSlider(console, now.size[k], box ? kBox[k] : kOther[k],
                              (k == 0 ? "radius " : std::string(kBox[k]) + " ") + now.name, 4 * row + k) ||
                   done;
        }
    }
    return done;
}

// The name, or a field for a new one: Enter takes it, Esc keeps the old one.
void nameOf(Console& console, FixtureEditor& editor, size_t i) {
    Console::Editing& editing = console.editing;
    const std::string name = editor.scene().fixtures[i].name;
    if (editing.renamed != name) {
        ImGui::TextUnformatted(name.c_str());
        return;
    }
    ImGui::SetNextItemWidth(ImGui::GetContentRegionAvail().x - 6.0f * ImGui::GetTextLineHeight());
    if (ImGui::IsWindowFocused(ImGuiFocusedFlags_ChildWindows) && !ImGui::IsAnyItemActive()) {
        ImGui::SetKeyboardFocusHere();
    }
    const bool done =
        ImGui::InputText("##name", editing.newName.data(), editing.newName.size(),
                         ImGuiInputTextFlags_EnterReturnsTrue | ImGuiInputTextFlags_AutoSelectAll);
    if (ImGui::IsItemActive()) { // one frame later it takes letters
        markPlace(console, "new name");
    }
    explain(console, "Enter: take this name. Esc: keep the old one");
    if (done) {
        const std::string wanted(editing.newName.data());
        const std::string problem = editor.rename(i, wanted);
        console.notify(problem.empty() ? "renamed to " + wanted : problem);
    }
    if (done || ImGui::IsItemDeactivated()) {
        editing.renamed.clear();
    }
}

void renameButton(Console& console, const std::string& name) {
    Console::Editing& editing = console.editing;
    if (markedButton(console, "Rename", "rename " + name, "Give this fixture another name")) {
        editing.renamed = name;
        editing.newName.fill(0);
        name.copy(editing.newName.data(), editing.newName.size() - 1);
    }
}

void showProblem(Console& console, const std::string& problem) {
    if (!problem.empty()) {
        console.notify(problem);
    }
}

// Returns whether the user chose a role.
bool roleOf(Console& console, FixtureClass& fixture) {
    int role = fixture.role == Role::Guidance ? 1 : 0;
    ImGui::SetNextItemWidth(110.0f * console.scale());
    const bool chosen = ImGui::Combo("##role", &role, "forbidden\0guidance\0");
    markPlace(console, "role " + fixture.name);
    explain(console, "forbidden: the tool is kept out. guidance: the tool is pulled there while G is on");
    fixture.role = role == 0 ? Role::Forbidden : Role::Guidance;
    ImGui::SameLine();
    return chosen;
}

// One fixture: name, role, sizes. Releasing a slider makes one undo step.
void row(Console& console, FixtureEditor& editor, size_t i, const SceneSnapshot& snapshot) {
    const FixtureClass before = editor.scene().fixtures[i];
    FixtureClass now = before;
    ImGui::PushID(static_cast<int>(i));
    const bool guides = now.role == Role::Guidance;
    ImGui::TextColored(ImColor(guides ? colour::kGuidance : colour::kRegionSoft), "%s", guides ? "+" : "#");
    explain(console, guides ? "+: guidance" : "#: forbidden");
    ImGui::SameLine();
    nameOf(console, editor, i);
    const float line = ImGui::GetTextLineHeight();
    ImGui::SameLine(ImGui::GetContentRegionMax().x - 6.6f * line);
    renameButton(console, before.name);
    ImGui::SameLine(ImGui::GetContentRegionMax().x - 1.7f * line);
    const bool removed =
        markedButton(console, "x", "remove " + now.name, "Remove this fixture; Ctrl Z brings it back");
    bool done = now.isPoints() && roleOf(console, now);
    const bool unbounded =
        now.shape == ShapeKind::Plane || now.shape == ShapeKind::Line || now.shape == ShapeKind::Axis;
    if (now.isPoints() ? now.role == Role::Forbidden : !unbounded) {
        done = sizes(console, now, static_cast<int>(i)) || done;
    } else {
        ImGui::NewLine();
    }
    if (now.isPoints()) {
        done = drawHolding(console, now, static_cast<int>(i), snapshot) || done;
    }
    if (removed) {
        editor.remove(i);
    } else if (done) {
        showProblem(console, editor.change(i, now));
    }
    ImGui::PopID();
}

void placeButtons(Console& console) {
    struct Kind {
        const char* name;
        ShapeKind kind;
        const char* tip;
    };
    constexpr Kind kKinds[] = {
        {"sphere", ShapeKind::Sphere, "Click on a surface: a sphere there that the tool cannot enter"},
        {"box", ShapeKind::Box, "Click on a surface: a box there that the tool cannot enter"},
        {"plane", ShapeKind::Plane, "Click on a surface: the tool stays on this side of it"},
        {"cyl.", ShapeKind::Cylinder, "Click on a surface: a cylinder there that the tool cannot enter"},
        {"line", ShapeKind::Line, "Click on its start and its end: the tool slides along this line"},
        {"axis", ShapeKind::Axis,
         "Click on its start and its end: the tool keeps to this axis and its direction"}};
    ImGui::TextDisabled("Place:");
    for (const auto& [name, kind, tip] : kKinds) {
        ImGui::SameLine(0.0f, 5.0f);
        if (markedButton(console, name, std::string("place ") + name, tip)) {
            console.placing.shape = console.placing.shape == kind ? ShapeKind::None : kind;
            console.placing.from.reset();
        }
    }
    if (console.placing.shape != ShapeKind::None) {
        ImGui::TextColored(ImColor(colour::kPicked),
                           "Click on a surface in the camera view, or use arrows and Enter.  Esc: cancel");
        drawPickWarnings(console);
    }
}

} // namespace

void handleFixtureKeys(Console& console, FixtureEditor& editor, const SceneSnapshot& snapshot) {
    Console::Requests& requests = console.requests;
    const ImGuiIO& io = ImGui::GetIO();
    const auto control = [&](int key) { return io.KeyCtrl && keyPressed(key); };
    if (keyPressed(GLFW_KEY_ESCAPE)) {
        console.stopAiming();
        editor.preview(console, snapshot);
    }
    const bool adds =
        console.pick.taken && !console.panels.haveKeys && !io.WantTextInput && keyPressed(GLFW_KEY_ENTER);
    if (adds || requests.addPicked) {
        const std::string problem = editor.takePicked(console);
        console.notify(problem.empty() ? "'" + editor.lastTaken() + "' is active" : problem);
    }
    if ((control(GLFW_KEY_Z) || requests.undo) && editor.undo()) {
        console.notify("undone");
    }
    if ((control(GLFW_KEY_Y) || requests.redo) && editor.redo()) {
        console.notify("redone");
    }
    if (control(GLFW_KEY_S) || requests.saveFixtures) {
        editor.keepSettings(console.settings.saved(), editor.scene().pilot);
        console.notify(editor.save());
    }
    requests.undo = requests.redo = requests.saveFixtures = requests.addPicked = false;
}

void drawFixtures(Console& console, FixtureEditor& editor, const SceneSnapshot& snapshot) {
    Console::Requests& requests = console.requests;
    bool& frozen = console.switches.frozen;
    const auto button = [&](const char* name, const char* tip) {
        const bool hit = markedButton(console, name, name, tip);
        ImGui::SameLine();
        return hit;
    };
    if (button("Pick (K)", "K, then click on a colour in the camera view: a new fixture of its points")) {
        console.pick = Pick{};
        console.pick.active = true;
    }
    requests.undo = button("Undo", "Ctrl Z: take back the last change of a fixture");
    requests.redo = button("Redo", "Ctrl Y: make it again");
    requests.saveFixtures =
        button("Save", "Ctrl S: write fixtures, pilot and window settings to the scene file");
    frozen = frozen != button(frozen ? "Unfreeze" : "Freeze",
                              "F: hold all fixtures as they are; new images do not change them");
    ImGui::NewLine();
    if (console.pick.active) {
        drawPick(console, editor, snapshot);
    }
    placeButtons(console);
    drawPilots(console, editor.scene());
    for (size_t i = 0; i < editor.scene().fixtures.size(); ++i) {
        if (!isSpare(editor.scene().fixtures[i])) {
            row(console, editor, i, snapshot);
        }
    }
}

} // namespace fathom::operate
