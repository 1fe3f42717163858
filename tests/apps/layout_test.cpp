// SPDX-License-Identifier: Apache-2.0
// Every screen of the window from 800x480 to 3840x2160 with text from 1x to 2.5x: no text is cut, none
// overlaps.
#include "apps/operate/monitor_scale.h"
#include "tests/apps/drawn_text.h"
#include "tests/apps/flat_wall.h"
#include "tests/apps/laid_screen.h"

#include <algorithm>
#include <doctest/doctest.h>
#include <string>

using namespace fathom;
using namespace fathom::operate;
using namespace fathom::testing;

namespace {

// List and corner of the first letters.
std::string placesOf(const std::vector<DrawnLetter>& letters) {
    std::string text;
    for (size_t i = 0; i < std::min<size_t>(3, letters.size()); ++i) {
        text += letters[i].list + " " + std::to_string(static_cast<int>(letters[i].box.x)) + "," +
                std::to_string(static_cast<int>(letters[i].box.y)) + "; ";
    }
    return text;
}

} // namespace

TEST_CASE(
    "Every screen from 800x480 to 3840x2160 with text from 1x to 2.5x has no text that is cut or overlaps, "
    "and the stop key") {
    LaidScreen laid;
    laid.run.console.switches.forces = laid.run.console.switches.frozen = true; // alarms
    laid.run.row.record.wrench.force = {20.0, 0.0, 0.0};
    laid.run.step({.handGone = true, .recorderFailed = "the disk is full"});
    const Console fresh;
    for (const ImVec2 size : {ImVec2(800, 480), ImVec2(1280, 720), ImVec2(1920, 1080), ImVec2(3840, 2160)}) {
        for (const double scale : {1.0, 1.5, 2.0, 2.5, 4.0}) {
            for (const bool pilot : {false, true}) {
                for (const LaidCase& screen : laidCases()) {
                    Console& console = laid.run.console;
                    console = fresh;
                    console.status.drawnScale = 0.0;
                    console.settings.pilotLayout = pilot;
                    laid.loadFontsFor(size, scale);
                    screen.set(console);
                    laid.draw();
                    CAPTURE(size.x);
                    CAPTURE(scale);
                    CAPTURE(pilot);
                    CAPTURE(std::string(screen.name));
                    const auto letters = drawnLetters();
                    CHECK(letters.size() > 60);
                    CHECK(placesOf(cutLetters(letters)) == "");
                    CHECK(placesOf(overlaps(letters)) == "");
                    if (console.timeLine.on) {
                        continue; // nothing is live
                    }
                    REQUIRE(console.places.contains("stop"));
                    const auto& stop = console.places.at("stop");
                    CHECK(stop[0] >= 0.0f);
                    CHECK(stop[0] + stop[2] <= size.x);
                    CHECK(stop[1] + stop[3] <= size.y);
                }
            }
        }
    }
}

TEST_CASE("With alarms, every tab is as wide as its name") {
    LaidScreen laid;
    laid.run.console.switches.forces = laid.run.console.switches.frozen = true;
    laid.run.step({.handGone = true, .recorderFailed = "the disk is full"});
    for (const ImVec2 size : {ImVec2(1280, 720), ImVec2(1600, 1000)}) {
        laid.loadFontsFor(size, 1.0);
        laid.draw();
        for (const char* name : {"Fixtures", "Why?", "Alarms", "Keys", "Camera", "Device"}) {
            CAPTURE(std::string(name));
            const float padding = ImGui::GetStyle().FramePadding.x;
            CHECK(laid.run.console.places.at(std::string("tab ") + name)[2] >=
                  ImGui::CalcTextSize(name).x + 2.0f * padding);
        }
    }
}

TEST_CASE("The tooltip of the stop plate has room round its text") {
    LaidScreen laid;
    laid.loadFontsFor({1280, 720}, 1.0);
    laid.draw();
    const auto stop = laid.run.console.places.at("stop");
    ImGui::GetIO().MousePos = {stop[0] + 0.5f * stop[2], stop[1] + 0.5f * stop[3]};
    ImGui::GetIO().DeltaTime = 0.25f;
    laid.draw(5);
    REQUIRE(laid.run.console.messages.tooltip.find("Space, or a click") == 0);
    size_t seen = 0;
    for (const DrawnLetter& l : drawnLetters()) {
        if (l.list.find("Tooltip") != std::string::npos) {
            CHECK(l.box.x > l.clip.x + 3.0f);
            ++seen;
        }
    }
    CHECK(seen > 20);
}

TEST_CASE("The values of distance and force do not cover each other") {
    LaidScreen laid;
    HostFixtures set = laid.run.view.scene().set;
    addRegion(set, {0.05, 0.0, 0.7}, 0.02, 0);
    laid.run.sink.frame({}, set);
    laid.run.view.refresh();
    laid.loadFontsFor({1280, 720}, 1.0);
    for (const double up : {0.0, 1.0, 2.0, 3.0}) {
        CAPTURE(up);
        laid.run.row.record.wrench.force = {3.3, -up, 0.0};
        laid.run.step(0.001);
        laid.draw();
        CHECK(placesOf(overlaps(drawnLetters())) == "");
    }
}

TEST_CASE("Text is as large as asked where the window has room, and smaller where not") {
    CHECK(scaleThatFits({3840, 2160}, 2.5, false) == 2.5);
    CHECK(scaleThatFits({1280, 720}, 1.25, false) == 1.25);
    CHECK(scaleThatFits({1280, 720}, 2.5, false) < 2.0);
    CHECK(scaleThatFits({1280, 720}, 2.0, true) == 2.0); // the pilot's layout has few words
    CHECK(scaleThatFits({800, 480}, 1.25, true) == 1.25);
    CHECK(scaleThatFits({640, 400}, 1.0, false) == 0.75);
    CHECK(scaleThatFits({9000, 9000}, 6.25, true) == 4.0);
}

TEST_CASE(
    "Text follows the desktop's scale, else the monitor's pixels per inch if its stated size is plausible") {
    CHECK(monitorScale({}) == 1.0);
    CHECK(monitorScale({.width = 1920, .millimetres = 508}) == 1.0);                 // 96 per inch
    CHECK(monitorScale({.width = 3840, .millimetres = 597}) == 1.625);               // 27 inches, 4K
    CHECK(monitorScale({.width = 3840, .millimetres = 1600}) == 1.0);                // a television
    CHECK(monitorScale({.width = 1024, .millimetres = 154}) == 1.75);                // 7 inches
    CHECK(monitorScale({.width = 1920, .millimetres = 16}) == 1.0);                  // an aspect ratio
    CHECK(monitorScale({.width = 3840, .millimetres = 100}) == 1.0);                 // nonsense
    CHECK(monitorScale({.desktop = 2.0, .width = 1920, .millimetres = 508}) == 2.0); // as it is set
    CHECK(monitorScale({.desktop = 2.0, .width = 3840, .stretch = 2.0}) == 1.0);     // drawn enlarged
    CHECK(monitorScale({.desktop = 4.0}) == 2.5);
}
