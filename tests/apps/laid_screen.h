// SPDX-License-Identifier: Apache-2.0
// The content of the window in an ImGui context without a display.
#pragma once

#include "apps/operate/screen.h"
#include "apps/operate/time_line_panel.h"
#include "apps/operate/traces_panel.h"
#include "tests/apps/viewed_run.h"

#include <functional>
#include <vector>

namespace fathom::testing {

using namespace fathom::operate;

// A scene with two fixtures, and everything that is drawn of it.
class LaidScreen {
public:
    LaidScreen();
    ~LaidScreen() { ImGui::DestroyContext(); }
    LaidScreen(const LaidScreen&) = delete;
    LaidScreen& operator=(const LaidScreen&) = delete;

    // The window's size [pixels] and the text that fits; call it again after changing the layout.
    void loadFontsFor(ImVec2 size, double scale);
    // Windows know their sizes and tabs are open after two frames.
    void draw(int frames = 3);

    ViewedRun run;
    Scene scene;
    Screen screen;
    Fonts fonts;
    ShownArm measured;
    CameraFacts recorded{"a recording with a rather long name, somewhere on this disk",
                         {{"depth", 640, 480, 30.0, "16 bit"}, {"colour", 1280, 720, 0.0, "RGB"}}};
    CameraControlThread noControls{nullptr};
    const CameraFacts* camera = &recorded;
    CameraControlThread* controlThread = &noControls; // of `camera`
    ButtonMap buttons{{1, 4, 0}};
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

// A state of the window.
struct LaidCase {
    const char* name;
    std::function<void(Console&)> set;
};
const std::vector<LaidCase>& laidCases();

} // namespace fathom::testing
