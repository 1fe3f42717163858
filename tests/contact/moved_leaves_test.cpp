// SPDX-License-Identifier: Apache-2.0
// What the narrow phase keeps from one search to the next stays enough while the leaves move.
#include "engine/contact/narrow_phase.h"

#include "engine/contact/cull_cpu.h"
#include "tests/contact/clouds.h"

#include <array>
#include <doctest/doctest.h>

using namespace fathom;
using namespace fathom::testing;

namespace {

constexpr double kBallRadius = 0.01, kRegion = 0.02; // [m] radii of leaves and spheres

// A tool of balls at `centres` and spheres, each at a gap [m] from the nearest ball along a direction.
struct MovedLeaves {
    Tool tool;
    HostFixtures fixtures = emptySet();
    ContactSet set;
    NarrowPhase narrow;
    LeafCentres leaves;

    explicit MovedLeaves(const std::vector<Sphere>& balls)
        : tool(makeTool(balls))
        , narrow(tool, 512)
        , leaves(tool.leafCount()) {}

    void addSphere(const dvec3& ball, const dvec3& way, double gap) {
        fixtures.spheres.add(ball + (kBallRadius + kRegion + gap) * way, kRegion);
    }
    void query() {
        CullCpu cull;
        RegionGrid grid;
        grid.build(fixtures.spheres);
        cull.query(tool, Pose{}, 0.01, fixtures, grid, set);
    }
    void gather(const dvec3& at, bool anew) {
        for (size_t i = 0; i < leaves.size(); ++i) {
            leaves.set(i, at + tool.leaves()[i].centre);
        }
        narrow.gather(set, leaves, at, 0.004, 0.002, anew);
    }
    size_t violationsOf(const dvec3& step) {
        LeafCentres next = leaves;
        for (size_t i = 0; i < next.size(); ++i) {
            next.set(i, leaves[i] + step);
        }
        const std::vector<dvec3> exempt(leaves.size(), dvec3(0.0));
        std::array<NarrowPhase::Violation, 8> out;
        return narrow.check(set, next, exempt, out);
    }
};

const dvec3 kRight(1, 0, 0), kUp(0, 1, 0);

} // namespace

TEST_CASE("A sphere beyond the first search is checked as soon as the leaf has moved near it") {
    MovedLeaves ball({{dvec3(0.0), kBallRadius}});
    ball.addSphere(dvec3(0.0), kRight, 0.0041); // the search goes to 4 mm, the check to 2 mm
    ball.query();
    ball.gather(dvec3(0.0), true);
    CHECK(ball.narrow.rows().empty());
    ball.gather(0.0022 * kRight, false);
    CHECK(ball.narrow.rows().size() == 1);
    CHECK(ball.violationsOf(0.00195 * kRight) == 1);
    CHECK(ball.violationsOf(0.00185 * kRight) == 0);
}

TEST_CASE("The check of a motion includes what the leaf has moved since its gaps were computed") {
    MovedLeaves ball({{dvec3(0.0), kBallRadius}});
    ball.addSphere(dvec3(0.0), kUp, 0.0002);
    ball.addSphere(dvec3(0.0), kRight, 0.00102);
    ball.query();
    ball.gather(dvec3(0.0), true);
    ball.gather(4e-5 * kRight, false); // too little for new gaps
    CHECK(ball.violationsOf(0.00099 * kRight) == 1);
    CHECK(ball.violationsOf(0.00097 * kRight) == 0);
}

TEST_CASE("The smallest gap is that of the present positions, also of a sphere that was far at the query") {
    const dvec3 above(0, 0.1, 0);
    for (const dvec3& near : {dvec3(0.0), above}) {
        MovedLeaves tool({{dvec3(0.0), kBallRadius}, {above, kBallRadius}});
        tool.addSphere(near - 0.005 * kRight, kUp, 0.0015);
        tool.addSphere(above - near, -kRight, 0.006);
        tool.query();
        tool.gather(-0.005 * kRight, false);
        CHECK(tool.narrow.smallestGapAt(tool.set, tool.leaves) == doctest::Approx(0.001).epsilon(1e-5));
    }
}
