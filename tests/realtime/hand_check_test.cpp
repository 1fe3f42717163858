// SPDX-License-Identifier: Apache-2.0
// Samples of a live hand that no hand can make.
#include "engine/run/hand_check.h"

#include <doctest/doctest.h>

#include <limits>

using namespace fathom;

namespace {

// A hand at 1 kHz that moves along x.
struct Samples {
    HandCheck check;
    double time = 0.0;

    StepInput next(const Pose& pose, bool present = true) {
        StepInput input = stepInput({pose, 0, present}, time += 0.001);
        check.judge(input);
        return input;
    }
    StepInput next(double x) { return next({{x, 0.0, 0.0}, {1.0, 0.0, 0.0, 0.0}}); }
};

} // namespace

TEST_CASE("A hand of up to 5 m/s and 50 rad/s is believed in every sample") {
    Samples samples;
    for (int i = 0; i < 200; ++i) {
        const StepInput input =
            samples.next({{0.0049 * i, 0.0, 0.0}, rotationExp(dvec3(0.0, 0.0, 0.049 * i))});
        CHECK_FALSE(input.unconfirmed);
        CHECK_FALSE(input.reindex);
    }
}

TEST_CASE("One implausible sample is unconfirmed, and the next plausible one is accepted at once") {
    for (const double wrong : {0.02, 1.0, 1e9, 1e200}) {
        Samples samples;
        for (int i = 0; i < 10; ++i) {
            samples.next(0.001 * i);
        }
        CHECK(samples.next(wrong).unconfirmed);
        const StepInput back = samples.next(0.011);
        CHECK_FALSE(back.unconfirmed);
        CHECK_FALSE(back.reindex);
    }
}

TEST_CASE(
    "A lasting offset is re-indexed after five samples, once, and samples that contradict each other stay "
    "unconfirmed") {
    Samples samples;
    samples.next(0.0);
    int unconfirmed = 0;
    StepInput input = samples.next(1.0);
    while (input.unconfirmed && unconfirmed < 100) {
        ++unconfirmed;
        input = samples.next(1.0);
    }
    CHECK(unconfirmed == 4);
    CHECK(input.reindex);
    input = samples.next(1.001);
    CHECK_FALSE(input.unconfirmed);
    CHECK_FALSE(input.reindex);
    for (int i = 0; i < 50; ++i) {
        CHECK(samples.next(i % 2 == 0 ? 30.0 : -30.0).unconfirmed);
    }
}

TEST_CASE("A device that was away is believed where it comes back") {
    Samples samples;
    samples.next(0.0);
    samples.next({{0.0, 0.0, 0.0}, {1.0, 0.0, 0.0, 0.0}}, false);
    const StepInput input = samples.next(0.3);
    CHECK_FALSE(input.unconfirmed);
    CHECK_FALSE(input.reindex);
}

TEST_CASE("A device that stays beyond belief counts as gone after 5 ms, and is never re-indexed far away") {
    for (const double far : {1e9, 1e30, 1e200}) {
        CAPTURE(far);
        Samples samples;
        samples.next(0.0);
        for (int i = 0; i < 50; ++i) {
            const StepInput input = samples.next(far);
            CHECK(input.unconfirmed);
            CHECK_FALSE(input.reindex);
            CHECK(input.present == (i <= 4));
        }
        const StepInput back = samples.next(0.0);
        CHECK(back.present);
        CHECK_FALSE(back.unconfirmed);
    }
}

TEST_CASE("Samples that are not finite let no jump pass, however many they are") {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const Pose noPlace{{nan, 0.0, 0.0}, {1.0, 0.0, 0.0, 0.0}}, noTurn{dvec3(0.0), {0.0, 0.0, 0.0, 0.0}};
    for (const Pose& broken : {noPlace, noTurn}) {
        for (const int count : {1, 5, 1000}) {
            CAPTURE(count);
            Samples samples;
            samples.next(0.0);
            for (int i = 0; i < count; ++i) {
                samples.next(broken);
            }
            StepInput input = samples.next(0.3);
            CHECK(input.unconfirmed);
            samples.next(broken); // nor does one in between
            for (int i = 0; i < 3; ++i) {
                CHECK(input.unconfirmed);
                input = samples.next(0.3);
            }
            CHECK(input.reindex);
            CHECK_FALSE(samples.next(0.301).unconfirmed);
        }
    }
}

TEST_CASE("A hand that is where it was before samples that are not finite is believed at once") {
    Samples samples;
    samples.next(0.0);
    samples.next({dvec3(0.0), {0.0, 0.0, 0.0, 0.0}});
    const StepInput input = samples.next(0.004);
    CHECK_FALSE(input.unconfirmed);
    CHECK_FALSE(input.reindex);
}

TEST_CASE("A first sample far from where the hand started is unconfirmed, and then re-indexed") {
    Samples samples;
    samples.check.begin({}, 0.0);
    StepInput input = samples.next(0.3);
    for (int i = 0; i < 4; ++i) {
        CHECK(input.unconfirmed);
        input = samples.next(0.3);
    }
    CHECK(input.reindex);
    Samples same;
    same.check.begin({}, 0.0);
    CHECK_FALSE(same.next(0.001).unconfirmed);
}
