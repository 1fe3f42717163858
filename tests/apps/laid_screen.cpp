// SPDX-License-Identifier: Apache-2.0
#include "tests/apps/laid_screen.h"

namespace fathom::testing {

LaidScreen::LaidScreen() {
    ImGui::CreateContext();
    ImGui::GetIO().IniFilename = nullptr;
    ImGui::GetIO().DeltaTime = 1.0f / 60.0f;
    FixtureClass red, yellow;
    red.name = "red valve", yellow.name = "yellow valve";
    yellow.role = Role::Guidance;
    scene.fixtures = {red, yellow};
    run.haptics.forceLimit = 20.0;
    HostFixtures set;
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

void LaidScreen::loadFontsFor(ImVec2 size, double scale) {
    ImGui::GetIO().DisplaySize = size;
    run.console.settings.textScale = scale;
    const double fits = scaleThatFits(size, scale, run.console.settings.pilotLayout);
    if (fits != run.console.status.drawnScale || fonts.body == nullptr) {
        run.console.status.drawnScale = fits;
        fonts = loadFonts(fits);
        applyTheme(fits);
        unsigned char* pixels = nullptr;
        int width = 0, height = 0;
        ImGui::GetIO().Fonts->GetTexDataAsAlpha8(&pixels, &width, &height);
    }
}

void LaidScreen::draw(int frames) {
    const std::vector<std::string> passes{"classify", "list", "surface", "thin", "moments", "spheres"};
    HudInput hud{.run = run.view,
                 .scene = scene,
                 .haptics = run.haptics,
                 .passNames = passes,
                 .fonts = fonts,
                 .title = "a recording with a rather long name, somewhere on this disk",
                 .camera = camera,
                 .controlThread = controlThread,
                 .device = {"a haptic device with a long name on a socket", true, 5, &buttons}};
    for (int i = 0; i < frames; ++i) {
        ImGui::NewFrame();
        screen.draw(run.console, editor, run.alarms, {run.view, tool, hud, i == 0, {}, measured});
        const auto at = [&](const char* name) { return run.console.places.at(name); };
        if (const auto room = at("traces room"); room[3] > 0.0f) {
            traces.draw(run.console, hud, {room[0], room[1]}, {room[2], room[3]});
        }
        if (const auto room = at("time line room"); room[3] > 0.0f) {
            timeLine.draw(run.console, fonts, {room[0], room[1]}, {room[2], room[3]});
        }
        ImGui::Render();
    }
}

const std::vector<LaidCase>& laidCases() {
    static const std::vector<LaidCase> kCases{
        {"fixtures", [](Console& c) { c.panels.tab = Tab::Fixtures; }},
        {"why", [](Console& c) { c.panels.tab = Tab::Why; }},
        {"alarms", [](Console& c) { c.panels.tab = Tab::Alarms; }},
        {"keys", [](Console& c) { c.panels.tab = Tab::Help; }},
        {"camera", [](Console& c) { c.panels.tab = Tab::Camera; }},
        {"device", [](Console& c) { c.panels.tab = Tab::Device; }},
        {"mapping",
         [](Console& c) {
             c.panels.tab = Tab::Device;
             c.editing.mapping = ButtonUse::Clutch;
         }},
        {"3D", [](Console& c) { c.settings.spaceIsLarge = true; }},
        {"armed, recording, guidance",
         [](Console& c) {
             c.switches.forces = c.switches.recording = c.switches.guidance = c.switches.frozen = true;
             c.status.recorded = {7323.0, 345'000'000'000, 998'000'000'000};
         }},
        {"refusal",
         [](Console& c) {
             c.messages.refusal = "hand is 105 mm inside 'red valve': hold C to re-centre";
             c.notify("recording to /home/pilot/recordings/2026-11-27/some-long-folder/recording-12");
         }},
        {"paused traces", [](Console& c) { c.panels.tracesPaused = true; }},
        {"look-back",
         [](Console& c) {
             c.timeLine.on = true, c.timeLine.frames = 300, c.timeLine.duration = 10.0;
             c.timeLine.marks = {{2.0, "mark 1"}, {2.1, "mark 2"}, {9.95, "mark 3"}};
         }},
        {"closing", [](Console& c) { c.closing.stage = ClosingStage::Asks; }},
        {"open",
         [](Console& c) {
             c.openCard.on = true;
             c.openCard.choices = {kLiveRun, "/home/pilot/recording-12", "/data/" + std::string(80, 'x')};
         }},
        {"panel open", [](Console& c) { c.panels.open = true; }},
        {"pick", [](Console& c) { c.pick.active = true; }},
        {"picked",
         [](Console& c) {
             c.pick.active = c.pick.taken = true;
             c.pick.gates.name = "picked 1";
             c.pick.found = {12, 1, 9, 1234, std::nullopt};
             c.pick.gates.hue = c.pick.gates.saturation = c.pick.gates.lightness = Band{0.1, 0.9};
         }},
    };
    return kCases;
}

} // namespace fathom::testing
