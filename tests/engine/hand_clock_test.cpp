// SPDX-License-Identifier: Apache-2.0
// Steps at times of another clock than that of the frames.
#include "tests/engine/wall_world.h"

#include <algorithm>
#include <cmath>
#include <doctest/doctest.h>
#include <limits>

using namespace fathom;
using namespace fathom::testing;

TEST_CASE(
    "Whatever the clock of the steps, forces come, fade without frames, and the next step may be on time") {
    Nanoseconds (*const clocks[])() = {[] { return now() / 1000; }, [] { return Nanoseconds{0}; },
                                       [] { return std::numeric_limits<Nanoseconds>::min(); },
                                       [] { return now() + 3'600'000'000'000; },
                                       [] { return std::numeric_limits<Nanoseconds>::max(); }};
    for (size_t i = 0; i < std::size(clocks); ++i) {
        CAPTURE(i);
        Engine engine(wallScene(), smallCamera());
        CameraPort port = engine.camera();
        HandPort hand = engine.openHand(startAt(0.5));
        const Wall wall;
        double z = 0.5;
        Step step;
        const auto force = [&] {
            step = hand.step(handAt(z), clocks[i]());
            CHECK(warns(step, StepWarning::OtherClock));
            return std::abs(step.wrench.force[2]);
        };
        REQUIRE(eventually([&] {
            CHECK(port.submit(wall.at(now())) == SubmitStatus::Accepted);
            z = std::min(0.56, z + 0.0005);
            return force() > 5.0;
        }));
        CHECK(eventually([&] { return force() == 0.0; }));
        CHECK(warns(step, StepWarning::OldScene));
        CHECK(eventually([&] { return !warns(hand.step(handAt(z), now()), StepWarning::OtherClock); }));
        CHECK_FALSE(warns(hand.step(handAt(z), now()), StepWarning::TimeBack));
    }
}

TEST_CASE("In lockstep a frame of the future gives no force until its time has come") {
    Lockstep lockstep(wallScene(), smallCamera(), startAt(0.54));
    lockstep.process(Wall().at(1'000'000'000));
    const auto forceAt = [&](int ms) {
        lockstep.queryContacts();
        const double z = std::min(0.56, 0.54 + 0.0005 * (ms - 600));
        const Step step = lockstep.step(handAt(z), Nanoseconds{ms} * 1'000'000);
        CHECK(warns(step, StepWarning::OldScene) == (ms < 900));
        return std::abs(step.wrench.force[2]);
    };
    double early = 0.0, late = 0.0;
    for (int ms = 600; ms < 900; ++ms) {
        early = std::max(early, forceAt(ms));
    }
    for (int ms = 900; ms < 1100; ++ms) {
        late = forceAt(ms);
    }
    CHECK(early == 0.0);
    CHECK(late > 5.0);
}

TEST_CASE("The last frame of a source that ended protects, however late the first step sees it") {
    for (const int firstMs : {20, 90, 200, 5000}) {
        CAPTURE(firstMs);
        Lockstep lockstep(wallScene(), smallCamera(), startAt(0.54));
        lockstep.process(Wall().at(0));
        lockstep.endFrames();
        Step step;
        for (int ms = firstMs; ms < firstMs + 1000; ++ms) {
            lockstep.queryContacts();
            const double z = std::min(0.56, 0.54 + 0.0001 * (ms - firstMs));
            step = lockstep.step(handAt(z), Nanoseconds{ms} * 1'000'000);
        }
        CHECK(step.state == State::Contact);
        CHECK(step.wrench.force[2] == doctest::Approx(-10.0).epsilon(1e-3));
        CHECK_FALSE(warns(step, StepWarning::OldScene));
    }
}

TEST_CASE("In lockstep a time that goes back is replaced by the last one, with a warning") {
    Lockstep lockstep(wallScene(), smallCamera(), startAt(0.5));
    lockstep.process(Wall().at(1'000'000'000));
    lockstep.queryContacts();
    Step step = lockstep.step(handAt(0.5), 1'100'000'000);
    CHECK_FALSE(warns(step, StepWarning::TimeBack));
    const double age = step.sceneAge;
    CHECK(age == doctest::Approx(0.1));
    for (const Nanoseconds back : {Nanoseconds{1'099'999'999}, Nanoseconds{0}, Nanoseconds{-1000},
                                   std::numeric_limits<Nanoseconds>::min()}) {
        step = lockstep.step(handAt(0.5), back);
        CHECK(warns(step, StepWarning::TimeBack));
        CHECK(step.sceneAge == age);
    }
    step = lockstep.step(handAt(0.5), 1'101'000'000);
    CHECK_FALSE(warns(step, StepWarning::TimeBack));
    CHECK(step.sceneAge == doctest::Approx(0.101));
}
