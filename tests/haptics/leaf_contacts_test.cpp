// SPDX-License-Identifier: Apache-2.0
// The leaves of a tool against the set that they obey: where it counts, and which leaves are behind a
// surface.
#include "engine/haptics/leaf_contacts.h"

#include "engine/contact/cull_cpu.h"
#include "tests/contact/clouds.h"

#include <doctest/doctest.h>

using namespace fathom;
using namespace fathom::testing;

namespace {

constexpr double kLeafRadius = 0.01, kRegionRadius = 0.04; // [m]

// A ball at the origin 2 mm above a region, and the set of a query there.
struct BallAndRegion {
    Tool tool = ballTool(kLeafRadius);
    HostFixtures fixtures = emptySet();
    ContactSet set;
    LeafContacts contacts{tool, {}, 0.001, RowReduction{}};

    BallAndRegion() {
        fixtures.spheres.add({0, 0, -(kLeafRadius + kRegionRadius + 0.002)}, kRegionRadius);
        RegionGrid grid;
        grid.build(fixtures.spheres);
        CullCpu cull;
        cull.query(tool, Pose{}, 0.01, fixtures, grid, set);
    }
    void gatherAt(const dvec3& at) {
        REQUIRE(contacts.use(&set, dvec3(0.0)));
        contacts.leaves.now.set(0, at);
        contacts.gather(at, true);
    }
};

} // namespace

TEST_CASE("A set counts while every leaf is within its reach less the margin, and not a bit farther") {
    BallAndRegion ball;
    LeafCentres leaves(1);
    for (const auto& [margins, counts] : {std::pair(1.5, true), {0.5, false}, {-0.5, false}}) {
        leaves.set(0, {ball.set.reach - margins * TrustRegion::kMargin, 0, 0});
        CHECK(TrustRegion::allows(ball.set, leaves) == counts);
    }
}

TEST_CASE("A leaf behind a surface is exempt until it has come out by what was left at the query") {
    BallAndRegion ball;
    ball.set.behind = {{0, dvec3(0, 0, 1), 0.003}};
    ball.gatherAt({0, 0, 0.0029});
    CHECK(ball.contacts.anyBehind());
    REQUIRE(ball.contacts.behindRows({0, 0, 0.0029}).size() == 1);
    CHECK(ball.contacts.behindRows({0, 0, 0.0029})[0].gap == doctest::Approx(-0.0001));
    ball.gatherAt({0, 0, 0.0031});
    CHECK_FALSE(ball.contacts.anyBehind());
    CHECK(ball.contacts.behindRows({0, 0, 0.0031}).empty());
}

TEST_CASE("A row is valid up to the travel at which its tangent plane is wrong by 0.5 mm") {
    const auto wayOf = [](const LeafContacts& contacts, ContactRow::Kind kind) {
        ActiveContact active;
        active.row.kind = kind;
        return contacts.tangentTravel({&active, 1});
    };
    const auto way = [](double radius) { return std::sqrt(2.0 * radius * LeafContacts::kTangentError); };
    BallAndRegion ball;
    ball.gatherAt(dvec3(0.0));
    CHECK(wayOf(ball.contacts, ContactRow::Kind::Sphere) == doctest::Approx(way(0.05)));
    Shape round;
    round.kind = ShapeKind::Sphere;
    round.size.x = 0.02;
    ball.contacts.setShapes({&round, 1});
    CHECK(wayOf(ball.contacts, ContactRow::Kind::Shape) == doctest::Approx(way(0.03)));
    Shape box; // its top face is 0.2 m by 0.1 m, the leaf above it 0.03 m from the long edge
    box.kind = ShapeKind::Box;
    box.size = {0.2, 0.1, 0.02};
    box.baseTshape.position = {0.0, 0.02, -0.02};
    ball.contacts.setShapes({&box, 1});
    CHECK(wayOf(ball.contacts, ContactRow::Kind::Shape) == doctest::Approx(0.03 + way(0.01)));
    box.keepIn = true;
    ball.contacts.setShapes({&box, 1});
    CHECK(std::isinf(wayOf(ball.contacts, ContactRow::Kind::Shape)));
    Shape rod; // the leaf is above its cap, outside of the rim
    rod.kind = ShapeKind::Cylinder;
    rod.size = {0.02, 0.1, 0.0};
    rod.baseTshape.position = {0.03, 0.0, -0.055};
    ball.contacts.setShapes({&rod, 1});
    CHECK(wayOf(ball.contacts, ContactRow::Kind::Shape) == doctest::Approx(way(0.01)));
}
