// SPDX-License-Identifier: Apache-2.0
// Which regions count as vanished, decided from one step to the next.
#include "engine/cycle/pressed_regions.h"
#include "tests/cycle/haptic_rig.h"

#include <doctest/doctest.h>

#include <optional>
#include <utility>

using namespace fathom;
using namespace fathom::testing;

namespace {

// A free tool at `rest`, where regions hold it against a spring to `end`. No contact set: shapes press.
struct PressedTool {
    explicit PressedTool(const Pose& springEnd, double reaction)
        : end(springEnd) {
        springs.stiffness = 1000.0;
        springs.metricRadius = 0.1;
        pressed.note(solved(held(rest), reaction), {});
    }
    ProxyStep held(const Pose& allowed) const {
        ProxyStep step;
        step.pose = step.allowed = allowed;
        step.active = {&row, 1};
        return step;
    }
    SolvedStep solved(const ProxyStep& moved, double reaction) const {
        return {moved, nullptr, tool, end, springs, reaction};
    }
    // The next step, in which the hand's end of the spring is at `springEnd`.
    std::optional<VanishedRegions> next(const ProxyStep& moved, const Pose& springEnd) {
        const StepPoses before{rest, rest, std::exchange(end, springEnd)};
        return pressed.vanished(solved(moved, 5.0), before);
    }

    const Pose rest = at(0.0, 0.0, 0.01);
    ActiveContact row;
    ToolProxy tool{ballTool(), {}, ProxyOptions{}, rest, nullptr};
    Springs springs;
    Pose end;
    PressedRegions pressed{ProxyOptions{}};
};

} // namespace

TEST_CASE("Regions that pressed have vanished when nothing is near although the hand stayed") {
    PressedTool tool(at(0.0, 0.0, 0.005), 5.0);
    REQUIRE(tool.pressed.any());
    const auto gone = tool.next(ProxyStep{}, tool.end);
    REQUIRE(gone);
    CHECK(gone->all);
    CHECK(gone->turned);
    CHECK(glm::distance(gone->along, {0.0, 0.0, 0.005}) <= 1e-12);
}

TEST_CASE("Regions that the hand left, or that hold the tool as before, have not vanished") {
    PressedTool left(at(0.0, 0.0, 0.005), 5.0);
    CHECK_FALSE(left.next(ProxyStep{}, at(0.0, 0.0, 0.012)));
    PressedTool still(at(0.0, 0.0, 0.005), 5.0);
    CHECK_FALSE(still.next(still.held(still.rest), still.end));
}

TEST_CASE("Of two regions that pressed, the direction of the one that vanished is found") {
    PressedTool tool(at(0.01, 0.0, 0.005), 11.0);
    const auto gone = tool.next(tool.held(at(0.01, 0.0, 0.01)), tool.end);
    REQUIRE(gone);
    CHECK_FALSE(gone->all);
    CHECK_FALSE(gone->turned);
    CHECK(glm::distance(gone->along, {-0.01, 0.0, 0.0}) <= 1e-12);
}

TEST_CASE("A region whose force cannot be felt does not vanish") {
    PressedTool tool(at(0.0, 0.0, 0.005), 0.4);
    CHECK_FALSE(tool.pressed.any());
    CHECK_FALSE(tool.next(ProxyStep{}, tool.end));
}

TEST_CASE("A trapped tool stays pressed until the hand is on the other side") {
    PressedTool tool(at(0.0, 0.0, 0.005), 5.0);
    ProxyStep trapped;
    trapped.trapped = true;
    tool.pressed.note(tool.solved(trapped, 0.0), {});
    CHECK(tool.pressed.any());
    tool.end = at(0.0, 0.0, 0.015);
    tool.pressed.note(tool.solved(trapped, 0.0), {});
    CHECK_FALSE(tool.pressed.any());
}
