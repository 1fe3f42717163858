// SPDX-License-Identifier: Apache-2.0
#include "apps/operate/holding_panel.h"

#include "apps/operate/theme.h"
#include "apps/output/silhouette.h"

#include <imgui.h>
#include <limits>

namespace fathom::operate {

namespace {

constexpr double kRoom = 0.01; // [m] margin of a new box around the points

// Box around the current points of the class; without points, around a point 1 m in front of the camera.
Box boxAbout(const HostFixtures& set, int row) {
    constexpr double kFar = std::numeric_limits<double>::infinity();
    Box box{dvec3(kFar), dvec3(-kFar)};
    for (size_t i = 0; i < set.spheres.size(); ++i) {
        if (set.spheres.fixture[i] == row) {
            const dvec3 at = regionCentre(set, i);
            box = {glm::min(box.min, at), glm::max(box.max, at)};
        }
    }
    if (box.min.x > box.max.x) {
        const dvec3 middle = set.baseTcamera.apply({0.0, 0.0, 1.0});
        return {middle - 0.2, middle + 0.2};
    }
    return {box.min - kRoom, box.max + kRoom};
}

// True when a dragged corner is released.
bool corner(Console& console, const char* name, const std::string& place, dvec3& corner, bool& dragged) {
    float v[] = {static_cast<float>(corner.x), static_cast<float>(corner.y), static_cast<float>(corner.z)};
    ImGui::SetNextItemWidth(ImGui::GetContentRegionAvail().x - 40.0f * console.scale());
    if (ImGui::DragFloat3(name, v, 0.002f, -1000.0f, 1000.0f, "%.3f m", ImGuiSliderFlags_AlwaysClamp)) {
        corner = {double{v[0]}, double{v[1]}, double{v[2]}};
        dragged = true;
    }
    markPlace(console, place);
    explain(console, "Corner of the box in the base frame: drag, or double click to type metres");
    return ImGui::IsItemDeactivatedAfterEdit();
}

bool boxCorners(Console& console, FixtureClass& now, int row) {
    Console::Editing& editing = console.editing;
    Box box = editing.boxRow == row ? editing.box : *now.box;
    bool dragged = false;
    bool done = corner(console, "min", "box min " + now.name, box.min, dragged);
    done = corner(console, "max", "box max " + now.name, box.max, dragged) || done;
    if (dragged) {
        editing.boxRow = row;
        editing.box = box;
    }
    if (done) {
        now.box = Box{glm::min(box.min, box.max), glm::max(box.min, box.max)};
        editing.boxRow = -1;
    }
    return done;
}

} // namespace

bool drawHolding(Console& console, FixtureClass& now, int row, const SceneSnapshot& snapshot) {
    bool done = false;
    if (markedButton(console, now.frozen ? "Release" : "Freeze", "hold " + now.name,
                     "Freeze this fixture: new frames do not change it. Again: release")) {
        now.frozen = !now.frozen;
        done = true;
    }
    ImGui::SameLine();
    if (markedButton(console, now.box ? "No box" : "Box", "box " + now.name,
                     "Only points inside a box belong to this fixture")) {
        now.box = now.box ? std::nullopt : std::optional(boxAbout(snapshot.set, row));
        console.editing.boxRow = -1;
        done = true;
    }
    ImGui::SameLine();
    if (markedButton(
            console, "Colour", "colour " + now.name,
            "Change the colours whose points belong to this fixture")) { // edits the gates of this class
        console.pick = Pick{};
        console.pick.active = console.pick.taken = true;
        console.pick.gates = now;
        console.pick.row = row;
        console.pick.fresh = true;
    }
    if (now.frozen) {
        ImGui::SameLine();
        ImGui::TextColored(ImColor(colour::kCaution), "frozen");
    }
    if (now.box && !done) {
        done = boxCorners(console, now, row);
    }
    return done;
}

void drawPilots(Console& console, const Scene& scene) {
    if (scene.pilots.empty()) {
        return;
    }
    ImGui::TextDisabled("Pilot:");
    for (const Scene::Pilot& pilot : scene.pilots) {
        ImGui::SameLine(0.0f, 5.0f);
        const bool chosen = pilot.name == scene.pilot;
        if (chosen) {
            ImGui::PushStyleColor(ImGuiCol_Button, ImGui::GetStyle().Colors[ImGuiCol_TabActive]);
        }
        if (markedButton(console, pilot.name.c_str(), "pilot " + pilot.name,
                         "Stiffness, limits and scale of this pilot. Forces go off first") &&
            !chosen) {
            console.requests.pilot = pilot.name;
        }
        if (chosen) {
            ImGui::PopStyleColor();
        }
    }
}

} // namespace fathom::operate
