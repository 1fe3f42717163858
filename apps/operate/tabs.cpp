// SPDX-License-Identifier: Apache-2.0
#include "apps/operate/tabs.h"

#include "apps/operate/steering.h"
#include "apps/operate/why_panel.h"

namespace fathom::operate {

namespace {

void drawKeys(const Console& console) {
    for (const KeyHelp& help : keyHelp()) {
        ImGui::TextColored(ImColor(colour::kGuidance), "%s", help.keys);
        ImGui::SameLine(150.0f * console.scale());
        ImGui::PushTextWrapPos(0.0f);
        ImGui::TextUnformatted(help.what);
        ImGui::PopTextWrapPos();
    }
}

// Grey: there is nothing to set.
bool isGrey(Tab tab, const HudInput& hud) {
    return (tab == Tab::Camera &&
            (hud.camera == nullptr || !whyNoControls(*hud.camera, *hud.controlThread).empty())) ||
           (tab == Tab::Device && hud.device.description.empty());
}

void drawContent(Console& console, FixtureEditor& editor, Alarms& alarms, const TabsInput& input, Tab tab) {
    ImGui::BeginChild("inside", ImVec2(0.0f, 0.0f), false, ImGuiWindowFlags_NavFlattened);
    if (tab == Tab::Fixtures) {
        drawFixtures(console, editor, input.run.scene());
    } else if (tab == Tab::Why) {
        drawWhy(input.run, editor.scene(), input.hud.armHolds);
    } else if (tab == Tab::Alarms) {
        drawAlarms(console, alarms);
    } else if (tab == Tab::Camera && input.hud.camera != nullptr) {
        drawCamera(console, *input.hud.camera, input.run, *input.hud.controlThread, input.hud.fonts);
    } else if (tab == Tab::Device) {
        drawDevice(console, input.hud.device, input.hud.fonts);
    } else if (tab == Tab::Help) {
        drawKeys(console);
    }
    ImGui::EndChild();
}

// Draws the tab of a panel; true when it is open.
bool beginTab(Console& console, const Alarms& alarms, const HudInput& hud, Tab tab, bool wanted) {
    constexpr const char* kNames[] = {"Fixtures", "Why?", "Alarms", "Keys", "Camera", "Device"};
    constexpr const char* kTips[] = {
        "K, or F6 and arrows: fixtures, shapes, pilots", "W: why did the tool stop?",
        "What is wrong, what to do, and what ended",     "F1: all keys",
        "F3: streams, delay, exposure, gain, laser",     "F4: what the buttons of the haptic device do"};
    const Alarm* worst = alarms.worst();
    const bool grey = isGrey(tab, hud), hasAlarm = tab == Tab::Alarms && worst != nullptr;
    const char* const name = kNames[static_cast<int>(tab)];
    if (hasAlarm || grey) {
        ImGui::PushStyleColor(ImGuiCol_Text, grey ? colour::kQuiet : levelColour(worst->level));
    }
    const bool open = ImGui::BeginTabItem(name, nullptr, wanted ? ImGuiTabItemFlags_SetSelected : 0);
    markPlace(console, std::string("tab ") + name);
    if (hasAlarm || grey) {
        ImGui::PopStyleColor();
    }
    explain(console, kTips[static_cast<int>(tab)]);
    if (hasAlarm) { // in the corner: a sign in the name would cut the names of other tabs
        const float r = 3.0f * console.scale();
        const ImVec2 corner{ImGui::GetItemRectMax().x, ImGui::GetItemRectMin().y};
        ImGui::GetWindowDrawList()->AddCircleFilled({corner.x - 1.6f * r, corner.y + 1.6f * r}, r,
                                                    levelColour(worst->level));
    }
    return open;
}

} // namespace

void drawTabs(Console& console, FixtureEditor& editor, Alarms& alarms, const TabsInput& input,
              const PixelRect& room) {
    ImGui::SetNextWindowPos(cornerOf(room));
    ImGui::SetNextWindowSize(sizeOf(room));
    ImGui::Begin("panels", nullptr, kPanel);
    if (ImGui::BeginTabBar("tabs")) {
        for (Tab tab : {Tab::Fixtures, Tab::Why, Tab::Alarms, Tab::Camera, Tab::Device, Tab::Help}) {
            const bool wanted = console.panels.tab == tab && console.panels.shownTab != tab;
            if (beginTab(console, alarms, input.hud, tab, wanted)) {
                console.panels.tab =
                    wanted || console.panels.tab == console.panels.shownTab ? tab : console.panels.tab;
                console.panels.shownTab = tab;
                drawContent(console, editor, alarms, input, tab);
                ImGui::EndTabItem();
            }
        }
        ImGui::EndTabBar();
    }
    ImGui::End();
}

} // namespace fathom::operate
