// SPDX-License-Identifier: Apache-2.0
// The proxy's guarantee under violent hands: no region is entered, however late the contact answers come.
#include "tests/haptics/proxy_rig.h"
#include "tests/support/sanitized.h"

#include <algorithm>
#include <doctest/doctest.h>

using namespace fathom;
using namespace fathom::testing;

namespace {

const dvec3 kX(1, 0, 0), kY(0, 1, 0), kZ(0, 0, 1);

Tool probe(double radius) { // a rod of overlapping spheres with a cross bar: rotation matters
    std::vector<Sphere> leaves;
    for (int i = 0; i < 7; ++i) {
        leaves.push_back({dvec3(0, 0, 0.01 * i), radius});
    }
    leaves.push_back({dvec3(0.03, 0, 0.05), radius});
    leaves.push_back({dvec3(-0.03, 0, 0.05), radius});
    return makeTool(leaves);
}

struct World {
    std::string name;
    HostFixtures fixtures;
    Tool tool;
    Pose start;
    dvec3 focus{0.0};    // attracts the hand, base frame
    double arena = 0.15; // [m]
};

World wall() {
    World w{"wall", emptySet(), probe(0.008), {dvec3(0, 0, 0.09), kUpright}};
    addWall(w.fixtures, dvec3(0.0), kX, kY, 0.15, 0.008, 0.04);
    return w;
}

World corner() {
    World w{"corner", emptySet(), probe(0.008), {dvec3(0.1, 0.1, 0.1), kUpright}};
    addWall(w.fixtures, dvec3(0.06, 0.06, 0), kX, kY, 0.15, 0.01, 0.03);
    addWall(w.fixtures, dvec3(0, 0.06, 0.06), kY, kZ, 0.15, 0.01, 0.03);
    addWall(w.fixtures, dvec3(0.06, 0, 0.06), kX, kZ, 0.15, 0.01, 0.03);
    return w;
}

World slot() { // 1 mm of clearance on each side
    World w{"slot", emptySet(), ballTool(0.01), {dvec3(0, 0, 0), kUpright}};
    addWall(w.fixtures, dvec3(0, 0, 0.031), kX, kY, 0.12, 0.005, 0.02);
    addWall(w.fixtures, dvec3(0, 0, -0.031), kX, kY, 0.12, 0.005, 0.02);
    return w;
}

World groove() { // 20 degrees between the walls
    World w{"groove", emptySet(), probe(0.006), {dvec3(0, 0, 0.34), kUpright}};
    const double a = 0.1745;
    for (const double side : {-1.0, 1.0}) {
        const dvec3 up(side * std::sin(a), 0, std::cos(a));
        addWall(w.fixtures, up * 0.15, kY, up, 0.15, 0.008, 0.02);
    }
    return w;
}

World needle() { // thin spikes and a thin tool; steps are longer than both
    World w{"needle",
            emptySet(),
            makeTool({{dvec3(0.0), 0.0005}, {dvec3(0, 0, 0.02), 0.0005}}),
            {dvec3(0.006, 0.003, -0.01), kUpright},
            dvec3(0.0),
            0.012};
    for (int i = -20; i <= 20; ++i) {
        w.fixtures.spheres.add(dvec3(0, 0.0005 * i, 0), 0.0002);
        w.fixtures.spheres.add(dvec3(0, 0, 0.0005 * i), 0.0002);
        w.fixtures.spheres.add(dvec3(0.0005 * i, 0, 0.005), 0.0001);
    }
    return w;
}

World rubble() {
    std::mt19937_64 random(99);
    World w{
        "rubble", randomCloud(random, 1500, 0.25, 0.002, 0.02), probe(0.006), {dvec3(0, 0, 0.29), kUpright}};
    w.fixtures.origin = dvec3(7321.5, -2204.25, 99.0);
    w.start.position += w.fixtures.origin;
    w.focus = w.fixtures.origin;
    return w;
}

// A hand that is attracted to the arena at up to `speed`, jumps up to 10 m and spins.
class Hand {
public:
    Hand(const World& world, double speed, uint64_t seed)
        : focus_(world.focus)
        , arena_(world.arena)
        , pose_(world.start)
        , speed_(speed)
        , random_(seed) {}

    Pose next() {
        std::uniform_real_distribution<double> u(0.0, 1.0);
        const double dice = u(random_);
        if (dice < 0.02) { // to a random position in the arena
            const dvec3 way = focus_ + randomIn(random_, arena_) - pose_.position;
            velocity_ = way * (speed_ * u(random_) / std::max(1e-6, glm::length(way)));
            spin_ = randomIn(random_, 20.0);
        } else if (dice < 0.022) {
            pose_ = {focus_ + randomIn(random_, 10.0), randomRotation(random_)};
        } else if (dice < 0.03) {
            pose_ = {focus_ + randomIn(random_, arena_), pose_.rotation};
        }
        pose_.position += velocity_ * 0.001;
        pose_.rotation = glm::normalize(rotationExp(spin_ * 0.001) * pose_.rotation);
        return pose_;
    }

private:
    dvec3 focus_;
    double arena_;
    Pose pose_;
    double speed_;
    std::mt19937_64 random_;
    dvec3 velocity_{0.0}, spin_{0.0};
};

struct Figures {
    double worst = -1e9, longest = 0.0, path = 0.0;
    uint64_t contact = 0, stalled = 0, trapped = 0, escape = 0, solves = 0, rounds = 0, bisected = 0,
             unaccepted = 0;
};

Figures run(ProxyRig& rig, Hand& hand, int ticks, uint32_t slowest, double loss, uint64_t seed) {
    Figures f;
    std::mt19937_64 random(seed);
    std::uniform_int_distribution<uint32_t> late(0, slowest);
    std::bernoulli_distribution lost(loss);
    LeafCentres before(rig.tool().leafCount()), after(rig.tool().leafCount());
    const LeafPlaces places(rig.tool());
    uint32_t delay = late(random);
    for (int k = 0; k < ticks; ++k) {
        delay = k % 50 == 0 ? late(random) : delay;
        places.place(rig.proxy().pose(), rig.fixtures().origin, before);
        const ProxyStep tick = rig.step(hand.next(), delay, lost(random));
        places.place(tick.pose, rig.fixtures().origin, after);
        const double travel = leafDisplacement(before, after);
        f.longest = std::max(f.longest, travel);
        f.path += travel;
        f.worst = std::max(f.worst, rig.depth());
        f.contact += tick.contact ? 1 : 0;
        f.stalled += tick.stalled ? 1 : 0;
        f.trapped += tick.trapped ? 1 : 0;
        f.escape += tick.escape ? 1 : 0;
        f.unaccepted += rig.proxy().accepts(rig.inForce()) ? 0 : 1;
        f.solves += tick.solves;
        f.rounds += tick.rounds;
        f.bisected += tick.bisected;
    }
    return f;
}

} // namespace

TEST_CASE("No leaf enters a region, however violent the hand and however late the contact answers") {
    World worlds[] = {wall(), corner(), slot(), groove(), needle(), rubble()};
    for (World& world : worlds) {
        for (const double speed : {0.05, 0.5, 5.0}) {
            for (const uint32_t slowest : {0u, 3u, 100u}) {
                if (kSanitized && (speed != 0.5 || slowest == 0)) {
                    continue;
                }
                ProxyRig rig(world.tool, world.fixtures, world.start);
                REQUIRE(rig.depth() < 0.0);
                Hand hand(world, speed, 1000 + slowest);
                const Figures f = run(rig, hand, 2000, slowest, slowest == 0 ? 0.0 : 0.3, 5);
                MESSAGE(world.name << " " << speed << " m/s late<=" << slowest << ": depth " << f.worst
                                   << " path " << f.path << " contact " << f.contact << " stalled "
                                   << f.stalled << " trapped " << f.trapped << " solves " << f.solves
                                   << " rounds " << f.rounds << " bisected " << f.bisected << " refused "
                                   << rig.refused);
                CHECK(f.worst <= 0.0);
                CHECK(f.longest <= 4 * 0.002 + 1e-9);
                CHECK(f.trapped == 0);
                CHECK(f.escape == 0);
                CHECK(f.unaccepted == 0);
                CHECK(f.path > 0.05);
                CHECK(f.contact > 5);
                if (slowest == 100 && speed >= 0.5) {
                    CHECK(f.stalled > 0);
                }
            }
        }
    }
}
