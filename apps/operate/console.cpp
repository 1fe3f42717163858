// SPDX-License-Identifier: Apache-2.0
#include "apps/operate/console.h"

#include <imgui.h>

namespace fathom::operate {

Pose Orbit::pose() const {
    const dquat turn = glm::angleAxis(-yaw, dvec3(0, 1, 0)) * glm::angleAxis(-pitch, dvec3(1, 0, 0));
    return {centre - turn * dvec3(0, 0, distance), turn};
}

void Console::tell(std::string words) {
    constexpr double kShown = 5.0; // [s]
    notice = std::move(words);
    noticeUntil = ImGui::GetTime() + kShown;
}

void Console::takeSettings(const Scene& scene, double chosenTextScale) {
    const Scene::Window kept = scene.window.value_or(Scene::Window{});
    textScale = chosenTextScale > 0.0 ? chosenTextScale : kept.textScale;
    spaceIsLarge = kept.spaceIsLarge;
    orbit.yaw = kept.yaw;
    orbit.pitch = kept.pitch;
    orbit.distance = kept.distance;
}

Scene::Window Console::settings() const {
    return {textScale, spaceIsLarge, orbit.yaw, orbit.pitch, orbit.distance};
}

void markPlace(Console& console, const std::string& name) {
    const ImVec2 a = ImGui::GetItemRectMin(), b = ImGui::GetItemRectMax();
    console.places[name] = {a.x, a.y, b.x - a.x, b.y - a.y};
}

} // namespace fathom::operate
