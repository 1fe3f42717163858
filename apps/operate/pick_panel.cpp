// SPDX-License-Identifier: Apache-2.0
// The panel of a picked colour: name, role, radius, and the gates with the hues of the image.
#include "apps/operate/pick_panel.h"

#include "apps/operate/theme.h"
#include "engine/types/printed.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace fathom::operate {

namespace {

// Only a band of hues may end below its start: it passes through 360 degrees. Of other bands, the end that is
// not moved follows.
Band movedBand(const Band& before, Band now, bool hues) {
    if (!hues && now.lo > now.hi) {
        (now.lo != before.lo ? now.hi : now.lo) = now.lo != before.lo ? now.lo : now.hi;
    }
    return now;
}

bool bandSlider(Console& console, const char* name, std::optional<Band>& band, float most) {
    if (!band) {
        return false;
    }
    float ends[] = {static_cast<float>(band->lo), static_cast<float>(band->hi)};
    const bool hues = most > 1.0f;
    const bool changed =
        ImGui::SliderFloat2(name, ends, 0.0f, most, hues ? "%.0f" : "%.2f", ImGuiSliderFlags_AlwaysClamp);
    markPlace(console, std::string("pick ") + name);
    explain(
        console,
        "Least and greatest value of the colours that belong to it; of hues, from the first to the second");
    if (changed) {
        band = movedBand(*band, {double{ends[0]}, double{ends[1]}}, hues);
    }
    return changed;
}

// Histogram of the image's hues in their own colours; hues inside the gate are bright.
void histogram(const std::array<float, 72>& hues, const FixtureClass& gates) {
    const float width = ImGui::GetContentRegionAvail().x, height = 38.0f;
    const ImVec2 at = ImGui::GetCursorScreenPos();
    ImDrawList& list = *ImGui::GetWindowDrawList();
    list.AddRectFilled(at, {at.x + width, at.y + height}, IM_COL32(12, 16, 23, 255), 3.0f);
    for (size_t i = 0; i < hues.size(); ++i) {
        const double hue = 5.0 * static_cast<double>(i) + 2.5;
        const bool in = gates.hue && inBand(gates.hue, hue);
        ImVec4 rgb(0, 0, 0, in ? 1.0f : 0.45f);
        ImGui::ColorConvertHSVtoRGB(static_cast<float>(hue / 360.0), 0.85f, 0.95f, rgb.x, rgb.y, rgb.z);
        const float x = at.x + width * static_cast<float>(i) / 72.0f;
        const float tall = std::max(1.0f, std::sqrt(hues[i]) * (height - 8.0f));
        list.AddRectFilled({x, at.y + height - 5.0f - tall}, {x + width / 72.0f - 1.0f, at.y + height - 5.0f},
                           ImColor(rgb));
        if (in) {
            list.AddRectFilled({x, at.y + height - 4.0f}, {x + width / 72.0f, at.y + height},
                               colour::kPicked);
        }
    }
    ImGui::Dummy({width, height});
}

void nameField(Console& console, FixtureClass& gates) {
    std::array<char, 64> name{};
    gates.name.copy(name.data(), name.size() - 1);
    if (ImGui::InputText("name", name.data(), name.size())) {
        gates.name = name.data();
    }
    markPlace(console, "pick name");
    explain(console, "Name of the new fixture");
}

void pickedRadius(Console& console, FixtureClass& gates) {
    float millimetres = static_cast<float>(1e3 * gates.radius);
    const float least = std::min(2.0f, millimetres), most = std::max(150.0f, millimetres);
    if (ImGui::SliderFloat("radius", &millimetres, least, most, "%.0f mm", ImGuiSliderFlags_AlwaysClamp)) {
        gates.radius = 1e-3 * static_cast<double>(millimetres);
    }
    markPlace(console, "pick radius");
    explain(console, "How far from each point the tool is kept");
}

// Name, role, radius and the button that makes it active.
void card(Console& console, FixtureClass& gates, bool anew) {
    if (anew) {
        nameField(console, gates);
    }
    int role = gates.role == Role::Forbidden ? 0 : 1;
    ImGui::RadioButton("forbidden", &role, 0);
    markPlace(console, "role forbidden");
    explain(console, "The tool is kept out");
    ImGui::SameLine();
    ImGui::RadioButton("guidance", &role, 1);
    markPlace(console, "role guidance");
    explain(console, "The tool is pulled there while G is on");
    gates.role = role == 0 ? Role::Forbidden : Role::Guidance;
    if (gates.role == Role::Forbidden) {
        pickedRadius(console, gates);
    }
    console.requests.addPicked = ImGui::Button(anew ? "Add  (Enter)" : "Change  (Enter)");
    markPlace(console, "add");
    explain(console, "Enter: make it active. Esc: drop it");
}

// What limits a new class to the clicked thing. True when it has changed.
bool partRules(Console& console, const SceneSnapshot& snapshot) {
    PartRules& rules = console.pick.rules;
    bool changed = ImGui::Checkbox("Only the clicked part", &rules.onlyClicked);
    markPlace(console, "only part");
    explain(console, "Of several things of this colour, only the one you clicked: a box around it limits the "
                     "fixture. Not for a thing that moves");
    const std::string specks =
        printed("Ignore specks under %u points", speckPoints(snapshot.set.camera.depth));
    changed = ImGui::Checkbox(specks.c_str(), &rules.noSpecks) || changed;
    markPlace(console, "no specks");
    explain(console, "Small separate parts do not count. Specks inside the box still do");
    return changed;
}

// How many points are selected, in how many parts.
void foundParts(const Console& console, const FixtureEditor& editor) {
    const PickedParts& found = console.pick.found;
    std::string text = printed("Selects %zu points (cyan)", editor.selectedPoints());
    if (console.pick.row < 0) {
        text += printed(": %u of %u connected parts", found.taken, found.parts);
    }
    ImGui::PushTextWrapPos(0.0f);
    ImGui::TextColored(ImColor(colour::kPicked), "%s", text.c_str());
    ImGui::PopTextWrapPos();
}

} // namespace

void drawPickWarnings(const Console& console) {
    ImGui::PushTextWrapPos(0.0f);
    for (const std::string& warning : console.pick.warnings) {
        colouredText(colour::kCaution, ("! " + warning).c_str());
    }
    ImGui::PopTextWrapPos();
}

void drawPick(Console& console, FixtureEditor& editor, const SceneSnapshot& snapshot) {
    if (!console.pick.taken) {
        ImGui::PushTextWrapPos(0.0f);
        ImGui::TextColored(ImColor(colour::kPicked),
                           "Click on a colour in the camera view, or use arrows and Enter.  Esc: cancel");
        ImGui::PopTextWrapPos();
        return;
    }
    FixtureClass& gates = console.pick.gates;
    if (std::exchange(console.pick.fresh, false)) {
        editor.preview(console, snapshot);
    }
    const bool anew = console.pick.row < 0;
    if (!anew) {
        ImGui::TextColored(ImColor(colour::kPicked), "'%s':", gates.name.c_str());
        ImGui::SameLine();
    }
    foundParts(console, editor);
    markPlace(console, "preview");
    drawPickWarnings(console);
    card(console, gates, anew);
    bool changed = anew && partRules(console, snapshot);
    histogram(editor.hues(), gates);
    changed = bandSlider(console, "hue", gates.hue, 360.0f) || changed;
    changed = bandSlider(console, "saturation", gates.saturation, 1.0f) || changed;
    changed = bandSlider(console, "lightness", gates.lightness, 1.0f) || changed;
    if (changed) {
        editor.preview(console, snapshot);
    }
}

} // namespace fathom::operate
