// SPDX-License-Identifier: Apache-2.0
// Every screen of the window from 800x480 to 3840x2160 with text from 1x to 2.5x: no text is cut, none
// overlaps.
#include "apps/operate/screen.h"
#include "apps/operate/time_line_panel.h"
#include "apps/operate/traces_panel.h"
#include "tests/apps/drawn_text.h"
#include "tests/apps/viewed_run.h"

#include <algorithm>
#include <doctest/doctest.h>
#include <functional>
#include <string>

using namespace fathom;
using namespace fathom::operate;
using namespace fathom::testing;

namespace {

class Laid {
public:
    Laid() {
        ImGui::CreateContext();
        ImGui::GetIO().IniFilename = nullptr;
        ImGui::GetIO().DeltaTime = 1.0f / 60.0f;
        FixtureClass red, yellow;
        red.name = "red valve", yellow.name = "yellow valve";
        yellow.role = Role::Guidance;
        scene.fixtures = {red, yellow};
        run.haptics.forceLimit = 20.0;
        Fixtures set;
        set.frame = 0;
        set.camera.depth.width = 64, set.camera.depth.height = 48;
        set.camera.depth.fx = set.camera.depth.fy = 60.0;
        set.camera.depth.cx = 31.5, set.camera.depth.cy = 23.5;
        set.camera.hasColour = false;
        set.camera.metresPerUnit = 0.001;
        set.depth.assign(size_t{64} * 48, 1000);
        run.sink.frame({}, set);
        run.view.refresh();
        run.row.record.tool.position = run.row.record.device.position = {0.0, 0.0, 0.7};
        run.row.record.clearance = 0.123;
        run.step(0.001);
    }
    ~Laid() { ImGui::DestroyContext(); }
    Laid(const Laid&) = delete;
    Laid& operator=(const Laid&) = delete;

    void fonts(ImVec2 size, double scale) {
        ImGui::GetIO().DisplaySize = size;
        run.console.textScale = scale;
        const double fits = scaleThatFits(size, scale, run.console.pilotLayout);
        if (fits != run.console.drawnScale || letters.body == nullptr) {
            run.console.drawnScale = fits;
            letters = loadLetters(fits);
            applyTheme(fits);
            unsigned char* pixels = nullptr;
            int width = 0, height = 0;
            ImGui::GetIO().Fonts->GetTexDataAsAlpha8(&pixels, &width, &height);
        }
    }
    // Three frames: windows know their sizes and tabs are open after two.
    void draw() {
        const std::vector<std::string> passes{"classify", "list", "surface", "thin", "moments", "spheres"};
        HudInput hud{.run = run.view,
                     .scene = scene,
                     .haptics = run.haptics,
                     .passNames = passes,
                     .letters = letters,
                     .title = "a recording with a rather long name, somewhere on this disk"};
        for (int i = 0; i < 3; ++i) {
            ImGui::NewFrame();
            screen.draw(run.console, editor, run.alarms, {run.view, tool, hud, i == 0, {}, measured});
            const auto at = [&](const char* name) { return run.console.places.at(name); };
            if (const auto room = at("traces room"); room[3] > 0.0f) {
                traces.draw(run.console, hud, {room[0], room[1]}, {room[2], room[3]});
            }
            if (const auto room = at("time line room"); room[3] > 0.0f) {
                timeLine.draw(run.console, letters, {room[0], room[1]}, {room[2], room[3]});
            }
            ImGui::Render();
        }
    }

    ViewedRun run;
    Scene scene;
    Screen screen;
    Letters letters;
    MeasuredArm measured;
    TracesPanel traces;
    TickLog log;
    TimeLinePanel timeLine{log, 10.0};
    Tool tool = [] {
        const Sphere ball{{0.0, 0.0, 0.0}, 0.01};
        return Tool(buildSphereTree({&ball, 1}));
    }();
    FixtureEditor editor{[] {
                             Scene s;
                             s.fixtures.resize(2);
                             s.fixtures[0].name = "red valve";
                             s.fixtures[1].name = "yellow valve";
                             s.fixtures[1].role = Role::Guidance;
                             return s;
                         }(),
                         [](const Scene&, const std::vector<Shape>&) {}};
};

// List and corner of the first letters.
std::string placesOf(const std::vector<DrawnLetter>& letters) {
    std::string text;
    for (size_t i = 0; i < std::min<size_t>(3, letters.size()); ++i) {
        text += letters[i].list + " " + std::to_string(static_cast<int>(letters[i].box.x)) + "," +
                std::to_string(static_cast<int>(letters[i].box.y)) + "; ";
    }
    return text;
}

struct Case {
    const char* name;
    std::function<void(Console&)> set;
};

const std::vector<Case>& screens() {
    static const std::vector<Case> kCases{
        {"fixtures", [](Console& c) { c.tab = Tab::Fixtures; }},
        {"why", [](Console& c) { c.tab = Tab::Why; }},
        {"alarms", [](Console& c) { c.tab = Tab::Alarms; }},
        {"keys", [](Console& c) { c.tab = Tab::Help; }},
        {"3D", [](Console& c) { c.spaceIsLarge = true; }},
        {"armed, recording, guidance",
         [](Console& c) { c.forces = c.recording = c.guidance = c.frozen = true; }},
        {"refusal",
         [](Console& c) {
             c.refusal = "hand is 105 mm inside 'red valve': hold C to re-centre";
             c.notify("recording to /home/pilot/recordings/2026-11-27/some-long-folder/recording-12");
         }},
        {"paused traces", [](Console& c) { c.paused = true; }},
        {"look-back",
         [](Console& c) { c.timeLine.on = true, c.timeLine.images = 300, c.timeLine.duration = 10.0; }},
        {"closing", [](Console& c) { c.closing = Closing::Asks; }},
        {"panel open", [](Console& c) { c.panelOpen = true; }},
        {"pick", [](Console& c) { c.pick.active = true; }},
    };
    return kCases;
}

} // namespace

TEST_CASE(
    "Every screen from 800x480 to 3840x2160 with text from 1x to 2.5x has no text that is cut or overlaps, "
    "and the stop key") {
    Laid laid;
    laid.run.console.forces = laid.run.console.frozen = true; // alarms
    laid.run.row.record.wrench.force = {20.0, 0.0, 0.0};
    laid.run.step({.handGone = true, .recorderFailed = "the disk is full"});
    const Console fresh;
    for (const ImVec2 size : {ImVec2(800, 480), ImVec2(1280, 720), ImVec2(1920, 1080), ImVec2(3840, 2160)}) {
        for (const double scale : {1.0, 1.5, 2.0, 2.5}) {
            for (const bool pilot : {false, true}) {
                for (const Case& screen : screens()) {
                    Console& console = laid.run.console;
                    console = fresh;
                    console.drawnScale = 0.0;
                    console.pilotLayout = pilot;
                    laid.fonts(size, scale);
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

TEST_CASE("Text is as large as asked where the window has room, and smaller where not") {
    CHECK(scaleThatFits({3840, 2160}, 2.5, false) == 2.5);
    CHECK(scaleThatFits({1280, 720}, 1.25, false) == 1.25);
    CHECK(scaleThatFits({1280, 720}, 2.5, false) < 2.0);
    CHECK(scaleThatFits({1280, 720}, 2.0, true) == 2.0); // the pilot's layout has few words
    CHECK(scaleThatFits({800, 480}, 1.25, true) == 1.25);
    CHECK(scaleThatFits({640, 400}, 1.0, false) == 0.75);
}
