// SPDX-License-Identifier: Apache-2.0
#include "apps/operate/console.h"

#include "apps/operate/disk_space.h"

#include <algorithm>
#include <cmath>
#include <imgui.h>

namespace fathom::operate {

Pose Orbit::pose() const {
    const dquat rotation = glm::angleAxis(-yaw, dvec3(0, 1, 0)) * glm::angleAxis(-pitch, dvec3(1, 0, 0));
    return {centre - rotation * dvec3(0, 0, distance), rotation};
}

std::string Recorded::text() const {
    return clockText(seconds) + ", " + byteText(bytes) + (left ? ", " + byteText(*left) + " left" : "");
}

void Console::stopAiming() {
    pick = Pick{};
    placing = {};
}

void Console::notify(std::string text) {
    constexpr double kShown = 5.0; // [s]
    messages.notice = std::move(text);
    messages.noticeUntil = ImGui::GetTime() + kShown;
}

void Console::Settings::take(const Scene& scene, double chosenTextScale) {
    const Scene::Window kept = scene.window.value_or(Scene::Window{});
    textScale = chosenTextScale > 0.0 ? chosenTextScale : kept.textScale;
    spaceIsLarge = kept.spaceIsLarge;
    pilotLayout = kept.pilotLayout;
    tones = kept.tones;
    orbit.yaw = kept.yaw;
    orbit.pitch = kept.pitch;
    orbit.distance = kept.distance;
}

Scene::Window Console::Settings::saved() const {
    return {textScale, spaceIsLarge, orbit.yaw, orbit.pitch, orbit.distance, pilotLayout, tones};
}

void markPlace(Console& console, const std::string& name) {
    markPlace(console, name, ImGui::GetItemRectMin(), ImGui::GetItemRectSize());
}

void markPlace(Console& console, const std::string& name, ImVec2 corner, ImVec2 size) {
    console.places[name] = {corner.x, corner.y, size.x, size.y};
}

bool markedButton(Console& console, const char* label, const std::string& name, const char* tip) {
    // Without vertical padding, as in a SmallButton, the frame cuts descenders.
    ImGui::PushStyleVar(ImGuiStyleVar_FramePadding,
                        {ImGui::GetStyle().FramePadding.x, std::max(1.0f, std::floor(console.scale()))});
    const bool pressed = ImGui::Button(label);
    ImGui::PopStyleVar();
    markPlace(console, name);
    explain(console, tip);
    return pressed;
}

namespace {

void showTip(Console& console, const char* tip) {
    constexpr double kAfter = 0.4; // [s]
    auto& pointed = console.messages.pointed;
    if (pointed.tip != tip || ImGui::GetFrameCount() > pointed.frame + 1) {
        pointed.tip = tip;
        pointed.since = ImGui::GetTime();
    }
    pointed.frame = ImGui::GetFrameCount();
    if (ImGui::GetTime() - pointed.since < kAfter) {
        return;
    }
    console.messages.tooltip = tip;
    const float pad = 8.0f * console.scale();
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {pad, pad}); // the stop plate has none
    ImGui::BeginTooltip();
    ImGui::PushTextWrapPos(26.0f * ImGui::GetFontSize());
    ImGui::TextUnformatted(tip);
    ImGui::PopTextWrapPos();
    ImGui::EndTooltip();
    ImGui::PopStyleVar();
}

} // namespace

void explain(Console& console, const char* tip) {
    if (ImGui::IsItemHovered()) {
        showTip(console, tip);
    }
}

bool explainArea(Console& console, ImVec2 corner, ImVec2 size, const char* tip) {
    const ImGuiIO& io = ImGui::GetIO();
    const bool held = ImGui::IsMouseDown(0) || ImGui::IsMouseDown(1);
    const bool inside = ImGui::IsMouseHoveringRect(corner, {corner.x + size.x, corner.y + size.y}, false);
    const bool there = inside && !held && !io.WantCaptureMouse;
    if (there) {
        showTip(console, tip);
    }
    return there;
}

void colouredText(ImU32 colour, const char* text) {
    ImGui::PushStyleColor(ImGuiCol_Text, colour);
    ImGui::TextWrapped("%s", text);
    ImGui::PopStyleColor();
}

void fontText(ImFont* font, ImU32 colour, const std::string& text) {
    ImGui::PushFont(font);
    ImGui::PushStyleColor(ImGuiCol_Text, colour);
    ImGui::TextUnformatted(text.c_str());
    ImGui::PopStyleColor();
    ImGui::PopFont();
}

} // namespace fathom::operate
