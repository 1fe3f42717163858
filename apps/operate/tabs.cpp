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

} // namespace

void drawTabs(Console& console, FixtureEditor& editor, Alarms& alarms, const TabsInput& input,
              const PixelRect& room) {
    ImGui::SetNextWindowPos(cornerOf(room));
    ImGui::SetNextWindowSize(sizeOf(room));
    ImGui::Begin("panels", nullptr, kPanel);
    constexpr const char* kNames[] = {"Fixtures", "Why?", "Alarms", "Keys"};
    constexpr const char* kTips[] = {"K, or F6 and arrows: fixtures, shapes, pilots",
                                     "W: why did the tool stop?",
                                     "What is wrong, what to do, and what is over", "F1: all keys"};
    if (ImGui::BeginTabBar("tabs")) {
        for (Tab tab : {Tab::Fixtures, Tab::Why, Tab::Alarms, Tab::Help}) {
            const bool wanted = console.tab == tab && console.shownTab != tab;
            const Alarm* worst = alarms.worst();
            const bool calls = tab == Tab::Alarms && worst != nullptr;
            const std::string name = std::string(kNames[static_cast<int>(tab)]) +
                                     (calls ? std::string(" ") + levelSign(worst->level) : "") + "###" +
                                     kNames[static_cast<int>(tab)];
            if (calls) {
                ImGui::PushStyleColor(ImGuiCol_Text, levelColour(worst->level));
            }
            const bool open =
                ImGui::BeginTabItem(name.c_str(), nullptr, wanted ? ImGuiTabItemFlags_SetSelected : 0);
            markPlace(console, std::string("tab ") + kNames[static_cast<int>(tab)]);
            explain(console, kTips[static_cast<int>(tab)]);
            if (calls) {
                ImGui::PopStyleColor();
            }
            if (!open) {
                continue;
            }
            console.tab = wanted || console.tab == console.shownTab ? tab : console.tab;
            console.shownTab = tab;
            ImGui::BeginChild("inside", ImVec2(0.0f, 0.0f), false, ImGuiWindowFlags_NavFlattened);
            if (tab == Tab::Fixtures) {
                drawFixtures(console, editor, input.run.scene());
            } else if (tab == Tab::Why) {
                drawWhy(input.run, editor.scene(), input.hud.armHolds);
            } else if (tab == Tab::Alarms) {
                drawAlarms(console, alarms);
            } else {
                drawKeys(console);
            }
            ImGui::EndChild();
            ImGui::EndTabItem();
        }
        ImGui::EndTabBar();
    }
    ImGui::End();
}

} // namespace fathom::operate
