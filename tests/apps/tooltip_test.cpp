// SPDX-License-Identifier: Apache-2.0
// Tooltips of the window: everything that can be pressed, dragged or read explains itself under the mouse.
#include "tests/apps/laid_screen.h"

#include <algorithm>
#include <doctest/doctest.h>

using namespace fathom;
using namespace fathom::testing;

namespace {

// Views, rooms and messages that say what they are.
bool speaksForItself(const std::string& place) {
    constexpr const char* kPlaces[] = {"camera",  "space",         "traces room", "time line room", "traces",
                                       "alarm",   "refusal",       "closing",     "close save",     "preview",
                                       "contact", "close discard", "close stay"};
    return std::find(std::begin(kPlaces), std::end(kPlaces), place) != std::end(kPlaces);
}

bool visible(const std::array<float, 4>& place) {
    const ImVec2 size = ImGui::GetIO().DisplaySize;
    return place[2] > 2.0f && place[3] > 2.0f && place[0] + 0.5f * place[2] < size.x &&
           place[1] + 0.5f * place[3] < size.y;
}

void pointAt(const std::array<float, 4>& place) {
    const ImVec2 at{place[0] + 0.5f * place[2], place[1] + 0.5f * place[3]};
    ImGui::GetIO().MousePos = at;
}

} // namespace

TEST_CASE("Every button, slider, tab, bar and figure has a tooltip") {
    LaidScreen laid;
    ImGui::GetIO().DeltaTime = 0.25f;
    const Console fresh;
    int checked = 0;
    for (const bool pilot : {false, true}) {
        for (const LaidCase& now : laidCases()) {
            Console& console = laid.run.console;
            console = fresh;
            console.status.drawnScale = 0.0;
            console.settings.pilotLayout = pilot;
            laid.loadFontsFor({1920, 1080}, 1.0);
            now.set(console);
            ImGui::GetIO().MousePos = {-1.0f, -1.0f};
            laid.draw();
            console.places.clear(); // of panels that were open before
            laid.draw(1);
            for (const auto& [name, place] : std::map(console.places)) {
                if (speaksForItself(name) || !visible(place)) {
                    continue;
                }
                pointAt(place);
                laid.draw(5);
                CAPTURE(std::string(now.name));
                const std::string shown = name;
                CAPTURE(shown);
                CHECK(console.messages.tooltip.size() > 8);
                ++checked;
            }
        }
    }
    CHECK(checked > 500);
}

TEST_CASE("A mouse on its way shows no tooltip, and a button that is held down none over a view") {
    LaidScreen laid;
    Console& console = laid.run.console;
    console.status.drawnScale = 0.0;
    laid.loadFontsFor({1280, 720}, 1.0);
    laid.draw();
    ImGui::GetIO().DeltaTime = 0.1f;
    pointAt(console.places.at("gap bar"));
    laid.draw(2);
    CHECK(console.messages.tooltip.empty());
    laid.draw(5);
    CHECK(console.messages.tooltip.find("Distance from the tool") == 0);
    ImGui::GetIO().MouseDown[0] = true;
    laid.draw(1);
    CHECK(console.messages.tooltip.empty());
}
