// SPDX-License-Identifier: Apache-2.0
#include "apps/operate/console.h"

#include <imgui.h>

namespace fathom::operate {

Pose Orbit::pose() const {
    const dquat rotation = glm::angleAxis(-yaw, dvec3(0, 1, 0)) * glm::angleAxis(-pitch, dvec3(1, 0, 0));
    return {centre - rotation * dvec3(0, 0, distance), rotation};
}

void Console::notify(std::string text) {
    constexpr double kShown = 5.0; // [s]
    notice = std::move(text);
    noticeUntil = ImGui::GetTime() + kShown;
}

void Console::takeSettings(const Scene& scene, double chosenTextScale) {
    const Scene::Window kept = scene.window.value_or(Scene::Window{});
    textScale = chosenTextScale > 0.0 ? chosenTextScale : kept.textScale;
    spaceIsLarge = kept.spaceIsLarge;
    pilotLayout = kept.pilotLayout;
    orbit.yaw = kept.yaw;
    orbit.pitch = kept.pitch;
    orbit.distance = kept.distance;
}

Scene::Window Console::settings() const {
    return {textScale, spaceIsLarge, orbit.yaw, orbit.pitch, orbit.distance, pilotLayout};
}

void markPlace(Console& console, const std::string& name) {
    markPlace(console, name, ImGui::GetItemRectMin(), ImGui::GetItemRectSize());
}

void markPlace(Console& console, const std::string& name, ImVec2 corner, ImVec2 size) {
    console.places[name] = {corner.x, corner.y, size.x, size.y};
}

bool markedButton(Console& console, const char* label, const std::string& name) {
    const bool pressed = ImGui::SmallButton(label);
    markPlace(console, name);
    return pressed;
}

void colouredText(ImU32 colour, const char* text) {
    ImGui::PushStyleColor(ImGuiCol_Text, colour);
    ImGui::TextWrapped("%s", text);
    ImGui::PopStyleColor();
}

} // namespace fathom::operate
