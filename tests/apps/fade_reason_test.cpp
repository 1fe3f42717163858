// SPDX-License-Identifier: Apache-2.0
// Why forces fade, as mode, chips and trace show it.
#include "apps/operate/mode.h"
#include "engine/types/joined.h"
#include "tests/apps/viewed_run.h"

#include <doctest/doctest.h>
#include <string>
#include <vector>

using namespace fathom;
using namespace fathom::operate;

TEST_CASE(
    "Forces that fade or are off name one cause: the dead-man switch, the device, regions or the camera") {
    ViewedRun run;
    const ModeInput input{run.console, run.view, run.haptics};
    run.console.switches.forces = true;
    run.row.record.frame = 3;
    std::vector<FadeReason> fades;
    const auto says = [&](StepState state, const std::string& chip, const std::string& meaning) {
        run.row.record.state = state;
        run.step(0.001);
        CAPTURE(std::string(modeOf(input).meaning));
        CHECK(joined(chipsOf(input), &Chip::word) == chip);
        fades.push_back(run.view.trace().back().fade);
        CHECK(std::string(modeOf(input).meaning).find(meaning) != std::string::npos);
    };
    for (const StepState state : {StepState::Fading, StepState::Off}) {
        run.row.hand = {};
        run.row.hand.buttons = kDeadManOpen | kGuidanceButton;
        says(state, "DEAD-MAN OPEN", "dead-man switch is open");
        run.row.hand.buttons = 0;
        run.row.hand.present = false;
        says(state, "DEVICE LOST", "device is lost");
        run.row.hand.present = true;
        says(state, "DEVICE LOST", "device was lost"); // several times: forces wait
    }
    ++run.row.record.vanished;
    says(StepState::Fading, "REGION GONE", "disappeared");
    run.row.record.t += 60.0;
    says(StepState::Fading, "", "without a known cause"); // no device was lost for long
    says(StepState::Off, "", "without a known cause");
    run.row.record.sceneAge = 0.11;
    says(StepState::Fading, "", "newest frame is too old");
    run.row.record.sceneAge = 0.6;
    says(StepState::Fading, "NO CAMERA IMAGE", "no camera image");
    run.row.record.sceneAge = -0.2;
    says(StepState::Fading, "", "ahead of the clock");
    run.console.switches.forces = false;
    says(StepState::Fading, "", "being switched off");
    using enum FadeReason;
    CHECK(fades == std::vector<FadeReason>{SwitchedOff, DeviceLost, DeviceWasLost, SwitchedOff, DeviceLost,
                                           DeviceWasLost, RegionGone, Unknown, Unknown, OldFrame, OldFrame,
                                           OldFrame, OldFrame});
}

TEST_CASE("If several reasons let forces fade, the trace names the one that mode and chips show") {
    ViewedRun run;
    const ModeInput input{run.console, run.view, run.haptics};
    run.console.switches.forces = true;
    run.row.record.frame = 3;
    run.row.record.state = StepState::Fading;
    run.row.record.sceneAge = 0.6;
    run.row.hand.buttons = kDeadManOpen;
    run.step(0.001);
    CHECK(std::string(modeOf(input).word) == "STALE");
    CHECK(joined(chipsOf(input), &Chip::word) == "NO CAMERA IMAGE");
    CHECK(run.view.trace().back().fade == FadeReason::OldFrame);
    run.row.record.sceneAge = 0.02;
    run.row.driven = true;
    run.row.armStatus.state = ArmState::Held;
    run.step(0.001);
    CHECK(joined(chipsOf(input), &Chip::word) == "DEAD-MAN OPEN");
    CHECK(run.view.trace().back().fade == FadeReason::SwitchedOff);
    run.row.hand.buttons = 0;
    run.row.hand.present = false;
    run.step(0.001);
    CHECK(std::string(modeOf(input).word) == "HELD");
    CHECK(joined(chipsOf(input), &Chip::word).empty());
    CHECK(run.view.trace().back().fade == FadeReason::ArmStill);
}

TEST_CASE("A new run does not inherit the reasons of the one before") {
    ViewedRun run;
    const ModeInput input{run.console, run.view, run.haptics};
    run.console.switches.forces = true;
    run.row.record.frame = 3;
    run.row.record.t = 100.0;
    run.row.hand.present = false;
    run.step(0.001);
    run.row.hand.present = true;
    run.row.record.vanished = 1;
    run.step(0.001);
    CHECK(run.view.regionsVanished());
    CHECK(run.view.deviceWasLost());
    run.row.record.state = StepState::Fading;
    for (const double t : {0.0, 50.0, 100.1}) { // of a new clock
        run.view.rewind();
        CHECK_FALSE(run.view.regionsVanished());
        CHECK_FALSE(run.view.deviceWasLost());
        run.row.record.t = t;
        run.step(0.001); // its count is of the time before
        run.step(0.001);
        CHECK(joined(chipsOf(input), &Chip::word).empty());
        CHECK(run.view.trace().back().fade == FadeReason::Unknown);
    }
}

TEST_CASE("While a real arm stands still, HELD has no chip that blames something else, except an old frame") {
    ViewedRun run;
    const ModeInput input{run.console, run.view, run.haptics};
    run.console.switches.forces = true;
    run.row.record.frame = 3;
    run.row.driven = true;
    for (const StepState state : {StepState::Fading, StepState::Off}) {
        run.row.record.state = state;
        for (const ArmState arm : {ArmState::Held, ArmState::Silent, ArmState::Behind}) {
            run.row.armStatus.state = arm;
            run.row.hand.present = false; // lost just before
            run.step(0.001);
            run.row.hand.present = true;
            for (const double age : {0.02, 0.2, 3.0}) {
                run.row.record.sceneAge = age;
                run.step(0.001);
                CHECK(std::string(modeOf(input).word) == "HELD");
                CHECK(joined(chipsOf(input), &Chip::word) == (age > 0.5 ? "NO CAMERA IMAGE" : ""));
            }
        }
    }
    run.row.armStatus.state = ArmState::Follows; // not yet seen by the run
    run.step(0.001);
    CHECK(std::string(modeOf(input).meaning).find("no camera image") != std::string::npos);
}
