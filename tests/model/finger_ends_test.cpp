// SPDX-License-Identifier: Apache-2.0
// Which end of a finger is closed when the scene does not say so.
#include "tests/model/urdf_text.h"

#include <algorithm>
#include <doctest/doctest.h>

using namespace fathom;
using namespace fathom::testing;

namespace {

std::string limit(const std::string& lower, const std::string& upper) {
    return "<limit lower='" + lower + "' upper='" + upper + "' velocity='1' effort='1'/>";
}

// A hand with more links and joints below it, whose first finger is the joint f1.
ArmModel handWith(const std::string& fingers, std::vector<ArmOptions::Finger> named = {{"f1", {}, {}}}) {
    ArmOptions options;
    options.tip = "hand";
    options.fingers = std::move(named);
    return loadUrdf(ballLink("base") + ballLink("hand") + ballLink("l") + ballLink("r") +
                        jointText("j1", "revolute", "base", "hand", "0 0 0.3", "0 1 0") + fingers,
                    options);
}

// Two jaws that slide along y from +-at on; the right one mirrors the left one.
std::string jaws(const std::string& at, const std::string& axis, const std::string& range) {
    return jointText("f1", "prismatic", "hand", "l", "0 " + at + " 0.1", axis, range) +
           jointText("f2", "prismatic", "hand", "r", "0 -" + at + " 0.1", axis,
                     range + mimicText("f1", "multiplier='-1'"));
}

void checkEnds(const ArmModel& arm, double open, double closed, bool seen = true) {
    CHECK(arm.fingers.at(0).open == open);
    CHECK(arm.fingers.at(0).closed == closed);
    const std::string words = seen ? ", as the shapes of the fingers show" : "do not tell";
    CHECK(std::ranges::any_of(arm.notes, [&](const std::string& note) {
        return note.starts_with("finger f1: ") && note.find(words) != std::string::npos;
    }));
}

} // namespace

TEST_CASE("Jaws close towards each other, whichever way their joints count") {
    checkEnds(handWith(jaws("0.03", "0 1 0", limit("0", "0.04"))), 0.04, 0.0);   // away from each other
    checkEnds(handWith(jaws("0.08", "0 -1 0", limit("0", "0.04"))), 0.0, 0.04);  // 0 is open
    checkEnds(handWith(jaws("0.08", "0 1 0", limit("-0.04", "0"))), 0.0, -0.04); // 0 is open
    const ArmModel arm = handWith(jaws("0.08", "0 -1 0", limit("0", "0.04")));
    CHECK(arm.fingers.at(1).open == 0.0); // follows
    CHECK(arm.fingers.at(1).closed == -0.04);
}

TEST_CASE("Fingers that turn close towards each other, also with a joint of their own each") {
    const auto turning = [](const std::string& range, const std::string& other) {
        return ballLink("lt") + ballLink("rt") +
               jointText("f1", "revolute", "hand", "l", "0 0.04 0.1", "1 0 0", range) +
               jointText("f2", "revolute", "hand", "r", "0 -0.04 0.1", "1 0 0", other) +
               jointText("tl", "fixed", "l", "lt", "0 0 0.1", "0 0 1", "") +
               jointText("tr", "fixed", "r", "rt", "0 0 0.1", "0 0 1", "");
    };
    const std::vector<ArmOptions::Finger> both{{"f1", {}, {}}, {"f2", {}, {}}};
    const ArmModel closes = handWith(turning(limit("0", "0.3"), limit("-0.3", "0")), both);
    checkEnds(closes, 0.0, 0.3);
    CHECK(closes.fingers.at(1).open == 0.0);
    CHECK(closes.fingers.at(1).closed == -0.3);
    const ArmModel opens = handWith(turning(limit("-0.3", "0"), limit("0", "0.3")), both);
    checkEnds(opens, -0.3, 0.0);
    CHECK(opens.fingers.at(1).open == 0.3);
    CHECK(opens.fingers.at(1).closed == 0.0);
}

TEST_CASE("A single finger closes towards what carries it, and given ends are kept") {
    const auto single = [](const std::string& axis) {
        return jointText("f1", "prismatic", "hand", "l", "0 0 0.05", axis, limit("0", "0.04")) +
               jointText("f2", "fixed", "hand", "r", "0 0.01 0", "0 1 0", "");
    };
    checkEnds(handWith(single("0 0 1")), 0.04, 0.0);
    checkEnds(handWith(single("0 0 -1")), 0.0, 0.04);
    const ArmModel given = handWith(single("0 0 -1"), {{"f1", 0.03, 0.01}});
    CHECK(given.fingers.at(0).open == 0.03);
    CHECK(given.fingers.at(0).closed == 0.01);
}

TEST_CASE("Where one end of a finger is given, the other is the limit farther away, and one note says so") {
    const auto hand = [](std::optional<double> open, std::optional<double> closed) {
        return handWith(jaws("0.08", "0 -1 0", limit("0", "0.04")), {{"f1", open, closed}});
    };
    const auto ends = [](const ArmModel& arm, double open, double closed, const std::string& words) {
        CHECK(arm.fingers.at(0).open == open);
        CHECK(arm.fingers.at(0).closed == closed);
        CHECK(arm.fingers.at(1).open == -open); // follows
        CHECK(std::ranges::count_if(
                  arm.notes, [&](const std::string& note) { return note.starts_with("finger f1: "); }) == 1);
        CHECK(std::ranges::count(arm.notes, "finger f1: " + words + "; grasp.fingers sets both") == 1);
    };
    ends(hand(0.03, {}), 0.03, 0.0, "closed at 0 is assumed, the limit farther from open at 0.03");
    ends(hand(0.0, {}), 0.0, 0.04, "closed at 0.04 is assumed, the limit farther from open at 0");
    ends(hand({}, 0.04), 0.0, 0.04, "open at 0 is assumed, the limit farther from closed at 0.04");
    ends(hand({}, 0.01), 0.04, 0.01, "open at 0.04 is assumed, the limit farther from closed at 0.01");
}

TEST_CASE("Fingers whose shapes do not tell keep the usual ends, and a note says so") {
    const std::string rolls =
        jointText("f1", "revolute", "hand", "l", "0 0.05 0.1", "0 1 0", limit("-1", "1")) +
        jointText("f2", "fixed", "hand", "r", "0 -0.05 0.1", "0 1 0", "");
    checkEnds(handWith(rolls), -1.0, 1.0, false);
}
