// SPDX-License-Identifier: Apache-2.0
// Row reduction: the same optimum when the remaining rows are checked, and never a leaf in a region.
#include "tests/haptics/proxy_rig.h"
#include "tests/support/sanitized.h"

#include <algorithm>
#include <array>
#include <doctest/doctest.h>
#include <memory>
#include <vector>

using namespace fathom;
using namespace fathom::testing;

namespace {

struct Walls {
    std::string name;
    HostFixtures fixtures;
    dvec3 start;
    double spread; // [m] hand motion about the start
    double into;   // [m] down from there to the middle of the hand's path
};

Walls wallCorner() {
    Walls w{"corner", emptySet(), dvec3(0.09, 0.09, 0.09), 0.06, 0.05};
    const dvec3 x(1, 0, 0), y(0, 1, 0), z(0, 0, 1);
    addWall(w.fixtures, dvec3(0.06, 0.06, 0), x, y, 0.12, 0.006, 0.03);
    addWall(w.fixtures, dvec3(0, 0.06, 0.06), y, z, 0.12, 0.006, 0.03);
    addWall(w.fixtures, dvec3(0.06, 0, 0.06), x, z, 0.12, 0.006, 0.03);
    return w;
}

Walls wallGroove() { // 40 degrees between the walls
    Walls w{"groove", emptySet(), dvec3(0, 0, 0.2), 0.05, 0.08};
    for (const double side : {-1.0, 1.0}) {
        const dvec3 up(side * std::sin(0.349), 0, std::cos(0.349));
        addWall(w.fixtures, up * 0.1, dvec3(0, 1, 0), up, 0.1, 0.005, 0.02);
    }
    return w;
}

Walls wallRubble() {
    std::mt19937_64 random(7);
    return {"rubble", randomCloud(random, 1500, 0.2, 0.004, 0.02), dvec3(0, 0, 0.3), 0.08, 0.1};
}

Tool manyLeaves() {
    std::mt19937_64 random(3);
    return randomTool(random, 60, 0.03, 0.006);
}

ProxyOptions optionsOf(const RowReduction& rows) {
    ProxyOptions options;
    options.rows = rows;
    options.solves = 1; // where a motion gains nothing, later solves depend on rounding
    return options;
}

// A hand that presses into the regions, wanders and rotates.
Pose handAt(const Walls& w, int tick) {
    const double t = 0.001 * tick;
    const dvec3 about(std::sin(5.1 * t), std::sin(6.7 * t + 1.0), std::sin(4.3 * t + 2.0));
    return {w.fixtures.origin + w.start - dvec3(0, 0, w.into * std::min(1.0, 4.0 * t)) + w.spread * about,
            rotationExp(dvec3(0.8 * std::sin(3.1 * t), 0.7 * std::sin(2.3 * t), 0.9 * std::sin(1.7 * t)))};
}

struct Against {
    double apart = 0.0;    // [m], 1 rad = 50 mm: largest difference after one tick from the same pose
    double deepest = -1.0; // [m] largest depth of any leaf
    uint32_t contact = 0, several = 0; // ticks; several: with more than one active row
    uint32_t otherRounds = 0;          // ticks that passed the exact check after a different number of rounds
};

// Every tick of each proxy starts at the pose of the proxy with all rows.
std::vector<Against> compare(const Walls& w, const std::vector<RowReduction>& reductions) {
    const Pose start{w.fixtures.origin + w.start, dquat(1, 0, 0, 0)};
    ProxyRig all(manyLeaves(), w.fixtures, start, optionsOf({}));
    std::vector<std::unique_ptr<ProxyRig>> fewer;
    for (const RowReduction& rows : reductions) {
        fewer.push_back(std::make_unique<ProxyRig>(manyLeaves(), w.fixtures, start, optionsOf(rows)));
    }
    std::vector<Against> results(reductions.size());
    for (int k = 0; k < 1200; ++k) {
        const Pose from = all.proxy().pose(), hand = handAt(w, k);
        all.query();
        const ProxyStep a = all.turnOnly(hand);
        for (size_t i = 0; i < fewer.size(); ++i) {
            ProxyRig& few = *fewer[i];
            few.proxy().setPose(from);
            few.query();
            const ProxyStep b = few.turnOnly(hand);
            const dvec3 turned = rotationBetween(a.pose.rotation, b.pose.rotation);
            const double apart =
                std::hypot(glm::distance(a.pose.position, b.pose.position), 0.05 * glm::length(turned));
            const bool comparable = a.rounds == b.rounds && a.bisected == b.bisected;
            Against& result = results[i];
            result.otherRounds += comparable ? 0 : 1;
            result.apart = comparable ? std::max(result.apart, apart) : result.apart;
            result.deepest = std::max(result.deepest, few.depth());
            result.contact += a.contact ? 1 : 0;
            result.several += a.active.size() > 1 ? 1 : 0;
        }
    }
    return results;
}

} // namespace

TEST_CASE("Solving on few rows and checking the rest gives the optimum over all rows in every tick") {
    std::vector<RowReduction> reductions;
    for (const uint32_t first : {1u, 3u, 8u, 33u}) {
        if (!kSanitized || first == 3) {
            reductions.push_back({2.0, NarrowPhase::kCone, first, true});
        }
    }
    const std::array worlds{wallCorner(), wallGroove(), wallRubble()};
    for (const Walls& world : worlds) {
        if (kSanitized && &world != &worlds.back()) {
            continue;
        }
        CAPTURE(world.name);
        const std::vector<Against> all = compare(world, reductions);
        for (size_t i = 0; i < all.size(); ++i) {
            const Against& found = all[i];
            CAPTURE(reductions[i].first);
            CHECK(found.apart < 1e-9);
            CHECK(found.otherRounds < 12); // of 1200: gaps that are 0 up to rounding
            CHECK(found.deepest <= 0.0);
            CHECK(found.contact > 300);
            CHECK(found.several > 100);
        }
    }
}

TEST_CASE("No choice of rows lets a leaf enter a region, and skipping rows unchecked changes the path") {
    std::vector<RowReduction> reductions{{2.0, NarrowPhase::kCone, 1, false}};
    if (!kSanitized) {
        reductions.insert(
            reductions.end(),
            {{2.0, NarrowPhase::kCone, 4, false}, {0.0, 0.0}, {1.0, 0.5 * M_PI}, {4.0, NarrowPhase::kCone}});
    }
    double farthest = 0.0;
    const std::array worlds{wallCorner(), wallGroove(), wallRubble()};
    for (const Walls& world : worlds) {
        if (kSanitized && &world != &worlds.back()) {
            continue;
        }
        CAPTURE(world.name);
        const std::vector<Against> found = compare(world, reductions);
        for (size_t i = 0; i < found.size(); ++i) {
            CAPTURE(reductions[i].first);
            CHECK(found[i].deepest <= 0.0);
            farthest = std::max(farthest, reductions[i].first > 0 ? found[i].apart : 0.0);
        }
    }
    CHECK(farthest > 1e-6); // or the test above would prove nothing
}

TEST_CASE(
    "Rows up to one step cap are safe too but change the path between walls, hence the default of two") {
    for (const Walls& world : {wallCorner(), wallGroove(), wallRubble()}) {
        if (kSanitized && world.name != "rubble") {
            continue;
        }
        CAPTURE(world.name);
        const Against found = compare(world, {{1.0, NarrowPhase::kCone}}).front();
        CHECK(found.deepest <= 0.0);
        CHECK(found.apart > 1e-4); // [m] in one tick with a step cap of 2 mm
        MESSAGE(world.name << ": up to " << found.apart * 1e3 << " mm per tick difference");
    }
}
