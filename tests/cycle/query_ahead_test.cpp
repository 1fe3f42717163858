// SPDX-License-Identifier: Apache-2.0
// Late answers are asked for where the tool will be.
#include "engine/cycle/query_ahead.h"

#include <doctest/doctest.h>

using namespace fathom;

namespace {

constexpr double kTick = 0.001;

// A tool that moved at `speed` [m/s] and `spin` [rad/s] until now.
struct Steady {
    QueryAhead ahead{kTick};
    ToolPlace now;

    Steady(const dvec3& speed, const dvec3& spin, double jointRate = 0.0) {
        for (int i = 0; i < 500; ++i) {
            now.pose = {i * kTick * speed, rotationExp(i * kTick * spin)};
            now.arm.q[1] = i * kTick * jointRate;
            ahead.moved(now, kTick);
        }
    }
};

} // namespace

TEST_CASE(
    "After late answers queries look ahead along the tool's motion, its rotation and the arm's joints") {
    Steady tool({0.1, 0, -0.2}, {0, 0, 2.0}, 0.5);
    CHECK(tool.ahead.ask(tool.now, 0.5, 3).place.pose.position == tool.now.pose.position); // none was late
    tool.ahead.answered(0.47, 0.5);
    const QueryPlace asked = tool.ahead.ask(tool.now, 0.5, 3);
    const dvec3 way = asked.place.pose.position - tool.now.pose.position;
    CHECK(glm::distance(way, 0.03 * dvec3(0.1, 0, -0.2)) < 1e-6);
    const dvec3 turn = rotationBetween(tool.now.pose.rotation, asked.place.pose.rotation);
    CHECK(glm::distance(turn, {0, 0, 0.06}) < 1e-6);
    CHECK(asked.place.arm.q[1] - tool.now.arm.q[1] == doctest::Approx(0.015));
    CHECK(asked.extraReach ==
          doctest::Approx(0.25 * 0.03 * std::sqrt(0.05) + 0.5 * QueryAhead::kHandAccel * 0.03 * 0.03));
}

TEST_CASE("The reach of a query grows by at most 20 mm, and a tool that was placed elsewhere has no speed") {
    Steady fast({5.0, 0, 0}, dvec3(0.0));
    fast.ahead.answered(0.0, 0.5);
    CHECK(fast.ahead.ask(fast.now, 0.5, 0).extraReach == QueryAhead::kMaxReach);
    fast.ahead.restart();
    ToolPlace elsewhere;
    elsewhere.pose.position = {7, 7, 7};
    fast.ahead.moved(elsewhere, kTick);
    CHECK(fast.ahead.ask(elsewhere, 0.5, 0).place.pose.position == elsewhere.pose.position);
}

TEST_CASE("A tick after a stall gives queries no speed that the tool never had") {
    constexpr double kStall = 0.03; // [s]
    Steady tool({0.3, 0, 0}, {0, 0, 2.0}, 0.5);
    tool.ahead.answered(0.47, 0.5);
    const QueryPlace before = tool.ahead.ask(tool.now, 0.5, 3);
    ToolPlace after = tool.now; // as fast as before
    after.pose.position += kStall * dvec3(0.3, 0, 0);
    after.pose.rotation = rotationExp(kStall * dvec3(0, 0, 2.0)) * after.pose.rotation;
    after.arm.q[1] += kStall * 0.5;
    tool.ahead.moved(after, kStall);
    const QueryPlace asked = tool.ahead.ask(after, 0.5 + kStall, 3);
    const auto way = [](const QueryPlace& ahead, const ToolPlace& from) {
        return glm::length(ahead.place.pose.position - from.pose.position);
    };
    CHECK(way(asked, after) == doctest::Approx(way(before, tool.now)));
    CHECK(glm::length(rotationBetween(after.pose.rotation, asked.place.pose.rotation)) ==
          doctest::Approx(glm::length(rotationBetween(tool.now.pose.rotation, before.place.pose.rotation))));
    CHECK(asked.place.arm.q[1] - after.arm.q[1] == doctest::Approx(0.015));
    CHECK(asked.extraReach == doctest::Approx(before.extraReach));
}

TEST_CASE("Ticks that are late in turns give queries the speed of the tool") {
    QueryAhead ahead(kTick);
    ToolPlace now;
    for (int i = 0; i < 500; ++i) {
        const double elapsed = i % 2 == 0 ? 1.9 * kTick : 0.1 * kTick;
        now.pose.position.x += 0.3 * elapsed;
        ahead.moved(now, elapsed);
    }
    ahead.answered(0.47, 0.5);
    const QueryPlace asked = ahead.ask(now, 0.5, 0);
    CHECK(asked.place.pose.position.x - now.pose.position.x == doctest::Approx(0.03 * 0.3));
}
