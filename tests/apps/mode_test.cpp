// SPDX-License-Identifier: Apache-2.0
// The state of the forces in one word, and the checks before they come on.
#include "apps/operate/arming.h"
#include "apps/operate/mode.h"
#include "apps/operate/theme.h"
#include "engine/cycle/wrench_stage.h"
#include "engine/types/joined.h"
#include "tests/apps/viewed_run.h"
#include "tests/support/contrast.h"

#include <doctest/doctest.h>
#include <set>

using namespace fathom;
using namespace fathom::operate;

TEST_CASE(
    "The mode is the worst state of the forces in one word, and chips say the rest without replacing it") {
    ViewedRun run;
    const ModeInput input{run.console, run.view, run.haptics};
    const auto mode = [&](StepState state, double guidance = 0.0) {
        run.row.record.state = state;
        run.row.record.guidance = guidance;
        run.step(0.001);
        return std::string(modeOf(input).word);
    };
    const auto chips = [&] { return joined(chipsOf(input), &Chip::word); };
    CHECK(mode(StepState::Free) == "FORCES OFF");
    CHECK(mode(StepState::Contact) == "FORCES OFF");
    CHECK(mode(StepState::Fading) == "FORCES FADING"); // they fade over some time
    run.console.switches.forces = true;
    CHECK(mode(StepState::Off) == "ARMED"); // no frame yet
    CHECK(chips() == "NO REGIONS YET");
    CHECK(mode(StepState::Free) == "ARMED");
    CHECK(chips().empty());
    CHECK(mode(StepState::Waiting) == "ARMED");
    CHECK(chips() == "LAGS");
    CHECK(mode(StepState::Contact, 0.5) == "CONTACT");
    CHECK(chips() == "GUIDE");
    CHECK(mode(StepState::Escape) == "CONTACT");
    run.row.record.wrench.force = dvec3(0.0, 0.0, 0.99 * run.haptics.forceLimit);
    CHECK(mode(StepState::Contact, 0.5) == "AT LIMIT");
    CHECK(chips() == "GUIDE");
    run.row.record.sceneAge = 0.11;
    CHECK(mode(StepState::Fading, 0.5) == "STALE");
    CHECK(mode(StepState::Trapped, 0.5) == "HELD");
    run.console.status.recorded = {62.0, 34'000'000, 2'100'000'000};
    run.console.switches.frozen = run.console.switches.recording = run.console.switches.guidance = true;
    CHECK(mode(StepState::Free) == "AT LIMIT");
    CHECK(chips() == "GUIDE: no target, FROZEN, REC 1:02, 34 MB, 2.1 GB left");
    run.row.record.wrench = {};
    run.console.timeLine.on = true;
    CHECK(mode(StepState::Contact) == "LOOK-BACK");
    CHECK(chips().find("CONTACT") == 0);
}

TEST_CASE(
    "While forces are armed but the dead-man switch is open or the device is lost, the mode is FORCES OFF") {
    ViewedRun run;
    const ModeInput input{run.console, run.view, run.haptics};
    run.console.switches.forces = true;
    run.row.record.frame = 3; // regions are known, and fresh
    run.row.record.sceneAge = 0.02;
    run.row.record.state = StepState::Fading;
    run.step(0.001);
    CHECK(std::string(modeOf(input).word) == "FORCES FADING");
    run.row.record.state = StepState::Off;
    run.step(0.001);
    CHECK(std::string(modeOf(input).word) == "FORCES OFF");
    run.row.record.sceneAge = -0.2; // a camera on another clock, ahead of the hand's
    run.row.record.state = StepState::Fading;
    run.step(0.001);
    CHECK(std::string(modeOf(input).word) == "STALE");
}

TEST_CASE("While guidance or a joint limit pushes the hand, ARMED does not say that nothing pushes") {
    ViewedRun run;
    const ModeInput input{run.console, run.view, run.haptics};
    run.console.switches.forces = true;
    const auto meaning = [&](uint32_t causes) {
        run.row.record.cause = causes;
        run.step(0.001);
        CHECK(std::string(modeOf(input).word) == "ARMED");
        return std::string(modeOf(input).meaning);
    };
    CHECK(meaning(0).find("nothing pushes") != std::string::npos);
    CHECK(meaning(cause::kGuidance | cause::kSlew).find("guidance pulls") != std::string::npos);
    CHECK(meaning(cause::kJoint).find("no fixture pushes") != std::string::npos);
}

TEST_CASE("Words of states, chips and alarms have a contrast of 7 to 1 over a white and a black image") {
    ViewedRun run;
    const ModeInput input{run.console, run.view, run.haptics};
    const auto check = [](ImU32 ink) {
        for (const double grey : {0.0, 1.0}) {
            const double plate = testing::luminance(testing::blended(colour::kPlate, {grey, grey, grey}));
            CHECK(testing::contrast(testing::luminance(testing::rgbOf(ink)), plate) >= 7.0);
        }
    };
    run.console.switches.guidance = run.console.switches.clutch = run.console.switches.frozen =
        run.console.switches.recording = true;
    for (const bool past : {false, true}) {
        for (const bool forces : {false, true}) {
            for (int state = 0; state <= static_cast<int>(StepState::Waiting); ++state) {
                for (const double force : {0.0, run.haptics.forceLimit}) {
                    run.console.timeLine.on = past, run.console.switches.forces = forces;
                    run.row.record.state = static_cast<StepState>(state);
                    run.row.record.wrench.force.x = force;
                    run.step(0.001);
                    const Mode mode = modeOf(input);
                    CAPTURE(std::string(mode.word));
                    check(mode.colour);
                    for (const Chip& chip : chipsOf(input)) {
                        CAPTURE(chip.word);
                        check(chip.colour);
                    }
                }
            }
        }
    }
    for (const Level level : {Level::Advisory, Level::Caution, Level::Warning}) {
        CAPTURE(std::string(levelName(level)));
        check(levelColour(level));
    }
}

TEST_CASE("Each mode has its own sign, colour or frame, and none of two looks the same without colour") {
    ViewedRun run;
    const ModeInput input{run.console, run.view, run.haptics};
    run.console.switches.forces = true;
    std::set<std::pair<std::string, Edge>> looks;
    run.row.record.sceneAge = 0.11; // a state of fading is stale
    const auto look = [&](StepState state) {
        run.row.record.state = state;
        run.step(0.001);
        const Mode mode = modeOf(input);
        looks.insert({mode.sign, mode.edge});
    };
    for (const StepState state :
         {StepState::Free, StepState::Contact, StepState::Trapped, StepState::Fading}) {
        look(state);
    }
    run.row.record.wrench.force = dvec3(run.haptics.forceLimit, 0.0, 0.0);
    look(StepState::Contact);
    run.console.switches.forces = false;
    look(StepState::Free);
    run.console.timeLine.on = true;
    look(StepState::Free);
    CHECK(looks.size() == 7);
}

TEST_CASE("Forces come on only with the hand on the tool, a fresh scene and the device, and the refusal says "
          "what to do") {
    ViewedRun run;
    Scene scene;
    const auto why = [&](bool gpuGone = false, bool handGone = false) {
        run.step(0.001);
        return whyNotArmed({run.view, scene, run.haptics, gpuGone, handGone});
    };
    run.row.record.frame = -1;
    CHECK(why() == "no camera frame has become a set of regions yet: wait for one");
    run.row.record.frame = 3;
    run.row.record.sceneAge = 0.01;
    CHECK(why().empty());
    CHECK(why(true).find("GPU is gone") != std::string::npos);
    CHECK(why(false, true) == "the haptic device is gone: connect it");
    run.row.record.sceneAge = 0.4; // a slow camera: forces fade between frames
    CHECK(why().empty());
    run.row.record.sceneAge = 0.6;
    CHECK(why() == "the newest regions are 600 ms old: check the camera");
    CHECK(cameraSilent(run.row.record));
    run.row.record.sceneAge = -0.6;
    CHECK(why() ==
          "the newest regions are 600 ms ahead of the clock: check which clock the camera stamps with");
    run.row.record.sceneAge = 0.01;
    run.row.record.device.position = run.row.record.tool.position + dvec3(0.0, 0.0, 0.009);
    CHECK(why().empty());
    run.row.record.device.position = run.row.record.tool.position + dvec3(0.0, 0.0, 0.105);
    CHECK(why() == "hand is 105 mm from the tool: hold C to re-centre");
    scene.fixtures.resize(1);
    scene.fixtures[0].name = "red valve";
    run.touch(3, 0.105);
    CHECK(why() == "hand is 105 mm inside 'red valve': hold C to re-centre");
    run.row.record.device = run.row.record.tool;
    run.row.record.device.rotation = dquat(std::cos(0.25), std::sin(0.25), 0.0, 0.0); // 0.5 rad
    CHECK(why().empty()); // in free space the tool follows
    run.row.record.contactCount = 1;
    CHECK(why() == "hand is turned against the tool: hold C to re-centre");
    run.haptics.clutchBit = 0;
    CHECK(why() == "hand is turned against the tool: turn it back");
    run.row.record.device = run.row.record.tool;
    scene.pilots.push_back({});
    CHECK(why() == "no pilot is chosen: choose one in the tab Fixtures");
}

TEST_CASE("Forces that come on take 1.5 s, and longer where that would be more than 20 N/s") {
    CHECK(softStart(5.0) == 1.5);
    CHECK(softStart(20.0) == 1.5);
    CHECK(softStart(40.0) == 2.0);
}
