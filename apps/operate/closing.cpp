// SPDX-License-Identifier: Apache-2.0
#include "apps/operate/closing.h"

#include "apps/operate/keys.h"
#include "apps/operate/theme.h"
#include "engine/types/log.h"

#include <GLFW/glfw3.h>
#include <utility>

namespace fathom::operate {

namespace {

CloseAnswer answerOf(Console& console) {
    const CloseAnswer clicked = std::exchange(console.closing.answer, CloseAnswer::None);
    return clicked != CloseAnswer::None        ? clicked
           : keyPressed(GLFW_KEY_ENTER, false) ? CloseAnswer::Save
           : keyPressed(GLFW_KEY_D, false)     ? CloseAnswer::Discard
           : keyPressed(GLFW_KEY_ESCAPE)       ? CloseAnswer::Stay
                                               : CloseAnswer::None;
}

void answer(Console& console, FixtureEditor& editor, CloseAnswer given) {
    Closing& closing = console.closing;
    if (given == CloseAnswer::Save) {
        editor.keepSettings(console.settings.saved(), editor.scene().pilot);
        console.notify(editor.save());
    }
    closing.quit = given == CloseAnswer::Discard || (given == CloseAnswer::Save && !editor.unsaved());
    console.openCard.next = closing.quit ? console.openCard.next : "";
    closing.stage = ClosingStage::No; // a file that cannot be written keeps the window open, with a notice
}

} // namespace

void stepClosing(Console& console, FixtureEditor& editor, const CloseInput& input) {
    Closing& closing = console.closing;
    if (closing.stage == ClosingStage::Asks) {
        closing.forcesRemain = closing.forcesRemain && !input.forcesGone;
        const CloseAnswer given = input.requested ? CloseAnswer::None : answerOf(console);
        if (given != CloseAnswer::None) {
            answer(console, editor, given);
        }
    } else if (input.requested && closing.stage == ClosingStage::No) {
        closing.stage = ClosingStage::Fades;
        closing.deadline = input.now + kLongestFade;
        closing.answer = CloseAnswer::None;
    }
    if (closing.stage == ClosingStage::No) {
        return;
    }
    console.switches.forcesOff();
    const bool late = !input.forcesGone && input.now > closing.deadline;
    if (closing.stage == ClosingStage::Fades && (input.forcesGone || late)) {
        if (late) {
            log::warn("closing: no tick without force in {} s; the end of the run switches forces off",
                      kLongestFade);
        }
        closing.forcesRemain = late;
        closing.quit = !editor.unsaved();
        closing.stage = ClosingStage::Asks;
        console.stopAiming(); // Enter answers the question
    }
}

void drawClosing(Console& console, ImVec2 corner, ImVec2 size) {
    for (const char* place : {"closing", "close save", "close discard", "close stay"}) {
        console.places.erase(place);
    }
    if (console.closing.stage != ClosingStage::Asks || console.closing.quit) {
        return;
    }
    ImGui::SetNextWindowPos({corner.x + 0.5f * size.x, corner.y + 0.5f * size.y}, ImGuiCond_Always,
                            {0.5f, 0.5f});
    ImGui::PushStyleVar(ImGuiStyleVar_WindowBorderSize, 2.0f);
    ImGui::PushStyleColor(ImGuiCol_Border, colour::kCaution);
    if (ImGui::Begin("closing", nullptr,
                     ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove |
                         ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_AlwaysAutoResize)) {
        ImGui::PushTextWrapPos(0.9f * size.x);
        ImGui::TextUnformatted(console.closing.forcesRemain ? "Forces are not off yet: closing ends them."
                                                            : "Forces are off.");
        ImGui::TextUnformatted("The fixtures have changes that are not saved.");
        ImGui::PopTextWrapPos();
        ImGui::Dummy({0.0f, 0.3f * ImGui::GetTextLineHeight()});
        const bool narrow = size.x < 36.0f * ImGui::GetTextLineHeight(); // one below the other
        const auto button = [&](const char* label, const char* place, CloseAnswer meaning) {
            console.closing.answer = ImGui::Button(label) ? meaning : console.closing.answer;
            if (!ImGui::IsWindowAppearing()) { // its size is not known in its first frame
                markPlace(console, place);
            }
            if (!narrow && meaning != CloseAnswer::Stay) {
                ImGui::SameLine();
            }
        };
        button("Save and close  (Enter)", "close save", CloseAnswer::Save);
        button("Discard and close  (D)", "close discard", CloseAnswer::Discard);
        button("Stay  (Esc)", "close stay", CloseAnswer::Stay);
        markPlace(console, "closing", ImGui::GetWindowPos(), ImGui::GetWindowSize());
    }
    ImGui::End();
    ImGui::PopStyleColor();
    ImGui::PopStyleVar();
}

} // namespace fathom::operate
