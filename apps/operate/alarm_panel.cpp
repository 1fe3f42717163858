// SPDX-License-Identifier: Apache-2.0
// Alarms as lines over the view, and as a panel with their history.
#include "apps/operate/alarms.h"
#include "apps/operate/theme.h"
#include "engine/types/printed.h"

#include <algorithm>

namespace fathom::operate {

namespace {

constexpr ImU32 kDimmed = IM_COL32(150, 162, 180, 200);
constexpr size_t kMaxLines = 3;

std::string timeText(double t) {
    const int minutes = static_cast<int>(t) / 60;
    return printed("%d:%04.1f", minutes, t - 60.0 * minutes);
}

// One line over a view on a dark plate; its height.
float alarmLine(ImVec2 at, float width, const std::string& words, ImU32 colour, bool bright) {
    ImDrawList& list = *ImGui::GetBackgroundDrawList();
    ImFont* const font = ImGui::GetFont();
    const float pad = 0.35f * font->FontSize, wrap = width - 2.0f * pad;
    const ImVec2 size = font->CalcTextSizeA(font->FontSize, wrap, wrap, words.c_str());
    list.AddRectFilled(at, {at.x + size.x + 3.0f * pad, at.y + size.y + 1.2f * pad},
                       bright ? colour::kPlate : colour::kShade, 4.0f);
    if (bright) {
        list.AddRectFilled(at, {at.x + 0.6f * pad, at.y + size.y + 1.2f * pad}, colour);
    }
    list.AddText(font, font->FontSize, {at.x + 1.6f * pad, at.y + 0.6f * pad}, colour, words.c_str(), nullptr,
                 wrap);
    return size.y + 1.2f * pad;
}

// A pilot must act on it, or at least see it.
bool isBright(const Alarm& alarm) {
    return alarm.active && !alarm.acknowledged;
}

std::string lineOf(const Alarm& alarm) {
    return (alarm.active ? std::string(levelSign(alarm.level)) + " " : "") + alarm.words();
}

} // namespace

void drawAlarmLines(Console& console, const Alarms& alarms, ImVec2 at, ImVec2 room) {
    console.places.erase("alarm");
    const std::vector<const Alarm*> shown = alarms.shown();
    std::vector<const Alarm*> order(shown);
    std::stable_sort(order.begin(), order.end(), [](const Alarm* a, const Alarm* b) {
        return std::pair(a->acknowledged, !a->active) < std::pair(b->acknowledged, !b->active);
    });
    const ImVec2 first = at;
    const float width = room.x,
                bottom = at.y + room.y - 2.2f * ImGui::GetTextLineHeight(); // one more line fits
    size_t lines = 0;
    for (const Alarm* alarm : order) {
        if (lines++ == kMaxLines || (lines > 1 && at.y > bottom)) {
            const std::string more = std::to_string(order.size() - lines + 1) + " more in the tab Alarms";
            at.y += alarmLine(at, width, more, kDimmed, false) + 3.0f;
            break;
        }
        const bool bright = isBright(*alarm);
        const std::string words = lineOf(*alarm) + (!alarm->acknowledged && lines == 1 ? "   Q: seen" : "");
        at.y += alarmLine(at, width, words, bright ? levelColour(alarm->level) : kDimmed, bright) + 3.0f;
    }
    if (!order.empty()) {
        markPlace(console, "alarm", first, {width, at.y - first.y});
    }
}

void drawAlarms(Console& console, const Alarms& alarms) {
    if (ImGui::Button("Acknowledge all  (Q)")) {
        console.requests.acknowledge = true;
    }
    markPlace(console, "acknowledge");
    explain(console, "Q: dim the alarms that you have seen. Ended ones go to the history");
    const auto list = alarms.shown();
    if (list.empty()) {
        ImGui::TextDisabled("No alarm.");
    }
    for (const Alarm* alarm : list) {
        colouredText(isBright(*alarm) ? levelColour(alarm->level) : kDimmed,
                     (timeText(alarm->since) + "  " + lineOf(*alarm)).c_str());
        if (ImGui::IsItemHovered()) {
            ImGui::SetTooltip("%s, %s, since %.3f s", levelName(alarm->level), alarm->key.c_str(),
                              alarm->since);
        }
    }
    if (alarms.history().empty()) {
        return;
    }
    ImGui::Separator();
    ImGui::TextDisabled("Ended:");
    for (const EndedAlarm& ended : alarms.history()) {
        colouredText(kDimmed, (std::string(levelSign(ended.level)) + " " + timeText(ended.since) + "  " +
                               ended.what + printed(", %.1f s", ended.end - ended.since))
                                  .c_str());
    }
}

} // namespace fathom::operate
