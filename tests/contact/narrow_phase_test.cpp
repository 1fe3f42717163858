// SPDX-License-Identifier: Apache-2.0
#include "engine/contact/narrow_phase.h"

#include "engine/contact/cull_cpu.h"
#include "engine/reference/contact_oracle.h"
#include "tests/contact/clouds.h"

#include <algorithm>
#include <array>
#include <doctest/doctest.h>
#include <limits>
#include <span>

using namespace fathom;
using namespace fathom::testing;

namespace {

struct Bench {
    Tool tool;
    HostFixtures fixtures;
    RegionGrid grid;
    CullCpu cull;
    ContactSet set;
    NarrowPhase narrow;
    LeafCentres leaves;

    Bench(Tool t, HostFixtures f, const Pose& pose, double reach = 0.01, size_t maxRows = 512)
        : tool(std::move(t))
        , fixtures(std::move(f))
        , narrow(tool, maxRows)
        , leaves(tool.leafCount()) {
        grid.build(fixtures.spheres);
        cull.query(tool, pose, reach, fixtures, grid, set);
        place(pose);
    }
    void place(const Pose& pose) {
        for (size_t i = 0; i < tool.leafCount(); ++i) {
            leaves.set(i, pose.apply(tool.leaves()[i].centre) - fixtures.origin);
        }
    }
    double gapOfSource(uint32_t leaf, uint32_t source) const {
        for (size_t s = 0; s < fixtures.spheres.size(); ++s) {
            if (fixtures.spheres.source[s] == source) {
                const RegionSpheres& all = fixtures.spheres;
                return glm::distance(leaves[leaf], dvec3(all.x[s], all.y[s], all.z[s])) -
                       (tool.leaves()[leaf].radius + all.radius[s]);
            }
        }
        return std::numeric_limits<double>::infinity();
    }
};

size_t checkAgainst(Bench& bench, const LeafCentres& next) {
    std::vector<dvec3> exempt(bench.tool.leafCount(), dvec3(0.0));
    std::vector<NarrowPhase::Violation> violations(bench.tool.leafCount());
    return bench.narrow.check(bench.set, next, exempt, violations);
}

// Number of leaves that the motion moves deeper than allowed into any sphere of the set, by dense samples of
// the path.
size_t sampledViolations(const Bench& bench, const LeafCentres& next) {
    size_t count = 0;
    const RegionSpheres& all = bench.fixtures.spheres;
    for (uint32_t leaf = 0; leaf < bench.tool.leafCount(); ++leaf) {
        bool violates = false;
        for (size_t s = 0; s < all.size(); ++s) {
            const dvec3 c(all.x[s], all.y[s], all.z[s]);
            const double sum = bench.tool.leaves()[leaf].radius + all.radius[s];
            const double start = glm::distance(bench.leaves[leaf], c) - sum;
            for (int k = 1; k <= 64; ++k) {
                const dvec3 p = bench.leaves[leaf] + (k / 64.0) * (next[leaf] - bench.leaves[leaf]);
                violates = violates || glm::distance(p, c) - sum < std::min(0.0, start) - 1e-12;
            }
        }
        count += violates ? 1 : 0;
    }
    return count;
}

// Rows with a gap below `sure` must be equal. Returns their number.
size_t sameRows(std::span<const ContactRow> a, std::span<const ContactRow> b, double sure) {
    const auto near = [sure](std::span<const ContactRow> rows) {
        std::vector<std::array<double, 6>> found;
        for (const ContactRow& row : rows) {
            if (row.gap < sure) {
                const dvec3& n = row.normal;
                found.push_back({double(row.leaf), double(row.pair), row.gap, n.x, n.y, n.z});
            }
        }
        return found;
    };
    CHECK(near(a) == near(b));
    return near(b).size();
}

} // namespace

TEST_CASE(
    "Every leaf gets a row for its nearest sphere, and every near sphere is in the cone of a nearer row") {
    std::mt19937_64 random(51);
    for (int k = 0; k < 20; ++k) {
        const Pose pose{randomIn(random, 0.1), randomRotation(random)};
        Bench bench(randomTool(random, 30, 0.08, 0.01), randomCloud(random, 1500, 0.2, 0.002, 0.03), pose);
        bench.place({pose.position + randomIn(random, 0.002), pose.rotation});
        bench.narrow.gather(bench.set, bench.leaves, pose.position, 0.004, 0.002, true);
        for (const OraclePair& pair : oraclePairs(bench.tool, pose, 0.02, bench.fixtures)) {
            const double gap = bench.gapOfSource(pair.leaf, pair.source);
            if (gap > 0.004) {
                continue;
            }
            bool covered = false;
            size_t rowsOfLeaf = 0;
            for (const ContactRow& row : bench.narrow.rows()) {
                if (row.leaf != pair.leaf) {
                    continue;
                }
                ++rowsOfLeaf;
                const uint32_t s = bench.set.pairSphere[row.pair];
                CHECK(row.gap == bench.gapOfSource(row.leaf, bench.set.source[s]));
                const auto at =
                    std::lower_bound(bench.set.source.begin(), bench.set.source.end(), pair.source) -
                    bench.set.source.begin();
                const dvec3 d =
                    bench.leaves[pair.leaf] - dvec3(bench.set.x[at], bench.set.y[at], bench.set.z[at]);
                covered = covered || (row.gap <= gap && glm::dot(glm::normalize(d), row.normal) > 0.866025);
            }
            CHECK((covered || rowsOfLeaf == 8)); // eight cones are kept at most
        }
    }
}

TEST_CASE("The exact check finds the same violations as dense samples of the path in the whole set") {
    std::mt19937_64 random(52);
    size_t violating = 0, clear = 0;
    for (int k = 0; k < 300; ++k) {
        const Pose pose{randomIn(random, 0.15), randomRotation(random)};
        Bench bench(randomTool(random, 6, 0.05, k % 3 == 0 ? 0.0003 : 0.01),
                    randomCloud(random, 400, 0.2, 0.0002, 0.02), pose);
        const Pose now{pose.position + randomIn(random, 0.004), pose.rotation};
        bench.place(now);
        bench.narrow.gather(bench.set, bench.leaves, now.position, 0.004, 0.002, true);
        LeafCentres next(bench.tool.leafCount());
        const dvec3 step = randomIn(random, 0.00115);
        for (size_t i = 0; i < next.size(); ++i) {
            next.set(i, bench.leaves[i] + step);
        }
        const size_t sampled = sampledViolations(bench, next);
        const size_t found = checkAgainst(bench, next);
        CHECK(found >= sampled);
        CHECK(found <= sampled + 1); // contacts shorter than a sample
        violating += found;
        clear += found == 0 ? 1 : 0;
    }
    MESSAGE("violations " << violating << ", clear motions " << clear);
    CHECK(violating > 20);
    CHECK(clear > 20);
}

TEST_CASE("After small and large motions the rows, smooth planes and violations are those of a new search, "
          "bit by bit") {
    constexpr double kSure = 0.0035; // [m] rows beyond may be missing after a motion
    std::mt19937_64 random(56);
    size_t rows = 0, planes = 0, violating = 0;
    for (int k = 0; k < 40; ++k) {
        HostFixtures wall = emptySet();
        addWall(wall, dvec3(0.0), dvec3(1, 0, 0), dvec3(0, 1, 0), 0.05, 0.002, 0.04);
        const Tool tool = randomTool(random, 20, 0.02, 0.01);
        Pose pose{dvec3(0, 0, 0.09), randomRotation(random)};
        Bench bench(tool, k % 2 == 0 ? wall : randomCloud(random, 3000, 0.1, 0.002, 0.03), pose, 0.08);
        pose.position.z -= bench.narrow.smallestGapAt(bench.set, bench.leaves) - 3e-4 * (k % 4);
        bench.cull.query(tool, pose, 0.01, bench.fixtures, bench.grid, bench.set);
        bench.place(pose);
        NarrowPhase again(tool, 512, NarrowPhase::kCone, true);
        again.gather(bench.set, bench.leaves, pose.position, 0.004, 0.002, true);
        for (const double far : {2e-5, 2e-5, 3e-4, 4e-5, 1e-6, 4e-3}) {
            pose.position += far * glm::normalize(randomIn(random, 1.0));
            bench.place(pose);
            NarrowPhase fresh(tool, 512, NarrowPhase::kCone, true);
            fresh.gather(bench.set, bench.leaves, pose.position, 0.004, 0.002, true);
            again.gather(bench.set, bench.leaves, pose.position, 0.004, 0.002, false);
            rows += sameRows(again.rows(), fresh.rows(), kSure);
            planes += sameRows(again.smoothRows(), fresh.smoothRows(), kSure);
            LeafCentres next = bench.leaves;
            const dvec3 step = randomIn(random, 0.00115);
            for (size_t i = 0; i < next.size(); ++i) {
                next.set(i, bench.leaves[i] + step);
            }
            std::vector<dvec3> exempt(next.size(), dvec3(0.0));
            std::vector<NarrowPhase::Violation> a(64), b(64);
            const size_t count = fresh.check(bench.set, next, exempt, a);
            REQUIRE(again.check(bench.set, next, exempt, b) == count);
            for (size_t v = 0; v < count; ++v) {
                CHECK(a[v].depth == b[v].depth);
                CHECK(a[v].row.pair == b[v].row.pair);
            }
            violating += count;
        }
    }
    MESSAGE("rows " << rows << ", planes " << planes << ", violations " << violating);
    CHECK(rows > 200);
    CHECK(planes > 50);
    CHECK(violating > 50);
}

TEST_CASE("A leaf gets a second row in the small motion that takes a sphere out of the cone of the first") {
    constexpr double kAngle = NarrowPhase::kCone - 1e-4; // [rad]
    HostFixtures fixtures = emptySet();
    fixtures.spheres.add(dvec3(0, 0, -0.0502), 0.04);
    fixtures.spheres.add(0.051 * dvec3(std::sin(kAngle), 0, -std::cos(kAngle)), 0.04);
    Bench bench(ballTool(0.01), fixtures, Pose{});
    bench.narrow.gather(bench.set, bench.leaves, dvec3(0.0), 0.004, 0.002, true);
    CHECK(bench.narrow.rows().size() == 1);
    bench.leaves.set(0, dvec3(0, 0, -4e-5));
    bench.narrow.gather(bench.set, bench.leaves, dvec3(0.0), 0.004, 0.002, false);
    CHECK(bench.narrow.rows().size() == 2);
}

TEST_CASE("In a corner of three walls a leaf gets a smooth plane per wall, on a flat wall one") {
    const std::array<dvec3, 3> axes{dvec3(1, 0, 0), dvec3(0, 1, 0), dvec3(0, 0, 1)};
    HostFixtures corner = emptySet();
    const dvec3 centre(0.0103, 0.0102, 0.0101); // of the leaf: 0.3, 0.2 and 0.1 mm from the walls
    for (size_t walls = 1; walls <= 3; ++walls) {
        const dvec3 &up = axes[3 - walls], &u = axes[(4 - walls) % 3], &v = axes[(5 - walls) % 3];
        addWall(corner, -0.04 * up, u, v, 0.03, 0.002, 0.04);
        Bench bench(ballTool(0.01), corner, Pose{centre, kUpright});
        NarrowPhase narrow(bench.tool, 512, NarrowPhase::kCone, true);
        narrow.gather(bench.set, bench.leaves, centre, 0.004, 0.002, true);
        REQUIRE(narrow.smoothRows().size() == walls);
        for (size_t w = 0; w < walls; ++w) { // the nearest wall first
            const ContactRow& row = narrow.smoothRows()[w];
            CHECK(glm::dot(row.normal, axes[2 - w]) > 0.9999);
            CHECK(row.gap == doctest::Approx(1e-4 * static_cast<double>(1 + w)).epsilon(0.05));
        }
    }
}

TEST_CASE("All touching pairs are checked, also when they exceed the lists") {
    HostFixtures fixtures = emptySet();
    addWall(fixtures, dvec3(0.0), dvec3(1, 0, 0), dvec3(0, 1, 0), 0.05, 0.0007, 0.04);
    std::mt19937_64 random(54);
    const Pose pose{dvec3(0, 0, 0.02), kUpright};
    Bench bench(randomTool(random, 40, 0.01, 0.02), std::move(fixtures), pose);
    REQUIRE(bench.set.pairSphere.size() > 200000);
    bench.narrow.gather(bench.set, bench.leaves, pose.position, 0.004, 0.002, true);
    LeafCentres next(40);
    for (size_t i = 0; i < 40; ++i) {
        next.set(i, bench.leaves[i] - dvec3(0, 0, 0.0005));
    }
    CHECK(checkAgainst(bench, next) == 40);
    CHECK(checkAgainst(bench, bench.leaves) == 0);
}

TEST_CASE("For coinciding centres the normal is the leaf's last one or the direction to the camera") {
    HostFixtures fixtures = emptySet();
    fixtures.baseTcamera.position = dvec3(0, -2, 0);
    fixtures.spheres.add(dvec3(0.0), 0.04);
    Bench bench(ballTool(0.01), fixtures, Pose{});
    bench.narrow.gather(bench.set, bench.leaves, dvec3(0.0), 0.004, 0.002, true);
    REQUIRE(bench.narrow.rows().size() == 1);
    CHECK(bench.narrow.rows()[0].normal == dvec3(0, -1, 0));
    bench.leaves.set(0, dvec3(0.001, 0, 0));
    bench.narrow.gather(bench.set, bench.leaves, dvec3(0.0), 0.004, 0.002, true);
    bench.leaves.set(0, dvec3(0.0));
    bench.narrow.gather(bench.set, bench.leaves, dvec3(0.0), 0.004, 0.002, true);
    CHECK(bench.narrow.rows()[0].normal == dvec3(1, 0, 0));
}

TEST_CASE("Only the deepest rows are kept when there are too many, and none when nothing is near") {
    std::mt19937_64 random(55);
    HostFixtures fixtures = emptySet();
    addWall(fixtures, dvec3(0.0), dvec3(1, 0, 0), dvec3(0, 1, 0), 0.1, 0.004, 0.04);
    const Tool tool = randomTool(random, 300, 0.02, 0.01);
    const Pose pose{dvec3(0, 0, 0.05), kUpright};
    Bench all(tool, fixtures, pose);
    Bench few(tool, fixtures, pose, 0.01, 10);
    all.narrow.gather(all.set, all.leaves, pose.position, 0.004, 0.002, true);
    few.narrow.gather(few.set, few.leaves, pose.position, 0.004, 0.002, true);
    REQUIRE(all.narrow.rows().size() > 50);
    REQUIRE(few.narrow.rows().size() == 10);
    std::vector<double> gaps;
    for (const ContactRow& row : all.narrow.rows()) {
        gaps.push_back(row.gap);
    }
    std::sort(gaps.begin(), gaps.end());
    for (const ContactRow& row : few.narrow.rows()) {
        CHECK(row.gap <= gaps[9]);
    }
    CHECK(all.narrow.smallestGapAt(all.set, all.leaves) == gaps[0]);
    Bench none(tool, emptySet(), pose);
    none.narrow.gather(none.set, none.leaves, pose.position, 0.004, 0.002, true);
    CHECK(none.narrow.rows().empty());
    CHECK(none.narrow.smallestGapAt(none.set, none.leaves) == 0.01);
}
