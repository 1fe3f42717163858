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
    const CloseAnswer clicked = std::exchange(console.closeAnswer, CloseAnswer::None);
    return clicked != CloseAnswer::None        ? clicked
           : keyPressed(GLFW_KEY_ENTER, false) ? CloseAnswer::Save
           : keyPressed(GLFW_KEY_D, false)     ? CloseAnswer::Discard
           : keyPressed(GLFW_KEY_ESCAPE)       ? CloseAnswer::Stay
                                               : CloseAnswer::None;
}

void answer(Console& console, FixtureEditor& editor, CloseAnswer given) {
    if (given == CloseAnswer::Save) {
        editor.keep(console.settings(), editor.scene().pilot);
        console.notify(editor.save());
    }
    console.quit = given == CloseAnswer::Discard || (given == CloseAnswer::Save && !editor.unsaved());
    console.openCard.next = console.quit ? console.openCard.next : "";
    console.closing = Closing::No; // a file that cannot be written keeps the window open, with a notice
}

} // namespace

void stepClosing(Console& console, FixtureEditor& editor, const CloseInput& input) {
    if (console.closing == Closing::Asks) {
        console.forcesLast = console.forcesLast && !input.forcesGone;
        const CloseAnswer given = input.requested ? CloseAnswer::None : answerOf(console);
        if (given != CloseAnswer::None) {
            answer(console, editor, given);
        }
    } else if (input.requested && console.closing == Closing::No) {
        console.closing = Closing::Fades;
        console.closeBy = input.now + kLongestFade;
        console.closeAnswer = CloseAnswer::None;
    }
    if (console.closing == Closing::No) {
        return;
    }
    console.forces = console.guidance = false;
    const bool late = !input.forcesGone && input.now > console.closeBy;
    if (console.closing == Closing::Fades && (input.forcesGone || late)) {
        if (late) {
            log::warn("closing: no tick without force in {} s; the end of the run switches forces off",
                      kLongestFade);
        }
        console.forcesLast = late;
        console.quit = !editor.unsaved();
        console.closing = Closing::Asks;
        console.pick = Pick{}; // Enter answers the question
        console.placing = ShapeKind::None;
    }
}

void drawClosing(Console& console, ImVec2 corner, ImVec2 size) {
    for (const char* place : {"closing", "close save", "close discard", "close stay"}) {
        console.places.erase(place);
    }
    if (console.closing != Closing::Asks || console.quit) {
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
        ImGui::TextUnformatted(console.forcesLast ? "Forces are not off yet: closing ends them."
                                                  : "Forces are off.");
        ImGui::TextUnformatted("The fixtures have changes that are not saved.");
        ImGui::PopTextWrapPos();
        ImGui::Dummy({0.0f, 0.3f * ImGui::GetTextLineHeight()});
        const bool narrow = size.x < 36.0f * ImGui::GetTextLineHeight(); // one below the other
        const auto button = [&](const char* label, const char* place, CloseAnswer meaning) {
            console.closeAnswer = ImGui::Button(label) ? meaning : console.closeAnswer;
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
