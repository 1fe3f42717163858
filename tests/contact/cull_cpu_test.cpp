// SPDX-License-Identifier: Apache-2.0
#include "engine/contact/cull_cpu.h"

#include "engine/reference/contact_oracle.h"
#include "tests/contact/clouds.h"

#include <algorithm>
#include <doctest/doctest.h>
#include <set>

using namespace fathom;
using namespace fathom::testing;

namespace {

struct Query {
    RegionGrid grid;
    CullCpu cull;
    ContactSet set;

    explicit Query(const QueryCapacity& capacity = {})
        : cull(capacity) {}
    const ContactSet& operator()(const Tool& tool, const Pose& pose, double reach,
                                 const HostFixtures& fixtures) {
        grid.build(fixtures.spheres);
        cull.query(tool, pose, reach, fixtures, grid, set);
        return set;
    }
};

// Structure of a set: bands in order, equal values in both layouts, gaps inside their band.
void checkShape(const Tool& tool, const ContactSet& set) {
    REQUIRE(set.pairBegin.size() == tool.leafCount() + 1);
    CHECK(std::is_sorted(set.source.begin(), set.source.end()));
    CHECK(set.pairBegin.front() == 0);
    CHECK(set.pairBegin.back() == set.pairSphere.size());
    size_t wrong = 0;
    for (size_t leaf = 0; leaf < tool.leafCount(); ++leaf) {
        uint32_t at = set.pairBegin[leaf];
        for (uint32_t band = 0; band < ContactSet::kGapBands; ++band) {
            for (; at < set.pairBandEnd[leaf * ContactSet::kGapBands + band]; ++at) {
                const uint32_t s = set.pairSphere[at];
                const dvec3 centre(set.x[s], set.y[s], set.z[s]);
                const double gap = glm::distance(set.leafAtQuery[leaf], centre) -
                                   (tool.leaves()[leaf].radius + set.radius[s]);
                wrong += set.bandOf(gap) == band ? 0 : 1;
                const bool first =
                    at == set.pairBegin[leaf] ||
                    (band > 0 && at == set.pairBandEnd[leaf * ContactSet::kGapBands + band - 1]);
                wrong += first || set.pairSphere[at - 1] < s ? 0 : 1; // by source within a band
                wrong += set.pairX[at] == set.x[s] && set.pairY[at] == set.y[s] && set.pairZ[at] == set.z[s]
                             ? 0
                             : 1;
                wrong += set.pairRadius[at] == set.radius[s] ? 0 : 1;
            }
        }
        wrong += at == set.pairBegin[leaf + 1] ? 0 : 1;
    }
    CHECK(wrong == 0);
}

void checkPairs(const Tool& tool, const Pose& pose, const HostFixtures& fixtures, const ContactSet& set) {
    std::set<std::pair<uint32_t, uint32_t>> listed;
    for (uint32_t leaf = 0; leaf < tool.leafCount(); ++leaf) {
        for (uint32_t k = set.pairBegin[leaf]; k < set.pairBegin[leaf + 1]; ++k) {
            listed.insert({leaf, set.source[set.pairSphere[k]]});
        }
    }
    CHECK(listed.size() == set.pairSphere.size());
    const std::vector<OraclePair> within = oraclePairs(tool, pose, set.reach, fixtures);
    size_t missed = 0;
    for (const OraclePair& pair : within) {
        missed += listed.count({pair.leaf, pair.source}) == 0 ? 1 : 0;
    }
    CHECK(missed == 0);
    CHECK(listed.size() <= oraclePairs(tool, pose, set.reach + 2e-9, fixtures).size());
}

} // namespace

TEST_CASE("The cull returns the same spheres as brute force for tools of 1 to 4096 leaves") {
    std::mt19937_64 random(11);
    size_t total = 0;
    for (const size_t leaves : {1, 2, 3, 37, 256, 1023, 4096}) {
        const Tool tool = randomTool(random, leaves, 0.15, 0.008);
        const HostFixtures fixtures = randomCloud(random, leaves > 1000 ? 1500 : 4001, 0.4, 0.001, 0.06);
        Query query;
        for (const double reach : {0.0, 0.001, 0.01, 0.05}) {
            const Pose pose{randomIn(random, 0.2), randomRotation(random)};
            const ContactSet& set = query(tool, pose, reach, fixtures);
            CHECK(set.source == oracleSources(tool, pose, reach, fixtures));
            CHECK(set.reach == reach);
            checkShape(tool, set);
            checkPairs(tool, pose, fixtures, set);
            total += set.size();
        }
    }
    MESSAGE("spheres in all sets: " << total);
    CHECK(total > 2000);
}

TEST_CASE("The cull equals brute force when the base frame's origin is kilometres away") {
    std::mt19937_64 random(12);
    HostFixtures fixtures = randomCloud(random, 3000, 0.4, 0.005, 0.05);
    fixtures.origin = dvec3(48123.75, -91234.5, 1234.125);
    const Tool tool = randomTool(random, 100, 0.1, 0.01);
    Query query;
    size_t total = 0;
    for (int k = 0; k < 20; ++k) {
        const Pose pose{fixtures.origin + randomIn(random, 0.4), randomRotation(random)};
        const ContactSet& set = query(tool, pose, 0.01, fixtures);
        CHECK(set.source == oracleSources(tool, pose, 0.01, fixtures));
        checkPairs(tool, pose, fixtures, set);
        total += set.size();
    }
    CHECK(total > 1000);
}

TEST_CASE("A tool kilometres from the origin keeps its whole reach and misses no pair within it") {
    std::mt19937_64 random(13);
    HostFixtures fixtures = emptySet();
    const dvec3 far(3000.0, -2000.0, 500.0);
    for (int i = 0; i < 3000; ++i) {
        fixtures.spheres.add(far + randomIn(random, 0.3), 0.03);
    }
    const Tool tool = randomTool(random, 50, 0.1, 0.01);
    Query query;
    const Pose pose{far, randomRotation(random)};
    const ContactSet& set = query(tool, pose, 0.01, fixtures);
    CHECK(set.reach == 0.01);
    CHECK(set.source == oracleSources(tool, pose, 0.01, fixtures));
    checkPairs(tool, pose, fixtures, set);
}

TEST_CASE("A sparse set is searched by patches of leaves, a dense one leaf by leaf, both like brute force") {
    std::mt19937_64 random(16);
    size_t byPatch = 0, byLeaf = 0, found = 0;
    for (const size_t spheres : {1, 700, 60000}) {
        const HostFixtures fixtures = randomCloud(random, spheres, spheres > 1000 ? 0.1 : 0.3, 0.01, 0.03);
        for (const size_t leaves : {7, 8, 32, 33, 65, 300}) {
            const Tool tool = randomTool(random, leaves, 0.1, 0.01);
            Query query;
            const Pose pose{randomIn(random, 0.2), randomRotation(random)};
            CHECK(query(tool, pose, 0.01, fixtures).source == oracleSources(tool, pose, 0.01, fixtures));
            found += query.set.size();
            PosedLeaves posed;
            poseLeaves(tool, pose, fixtures.origin, posed);
            const bool patches = PatchCull::isFaster(posed, 0.01f, query.grid);
            CHECK(!(patches && leaves < 8));
            (patches ? byPatch : byLeaf) += 1;
        }
    }
    CHECK(byPatch == 10); // 5 tools of 8 leaves or more, 2 sparse sets
    CHECK(byLeaf == 8);
    CHECK(found > 10000);
}

TEST_CASE("No spheres, or none within reach, give an empty set that certifies its reach") {
    std::mt19937_64 random(14);
    const Tool tool = randomTool(random, 9, 0.1, 0.01);
    Query query;
    CHECK(query(tool, Pose{}, 0.01, emptySet()).size() == 0);
    CHECK(query.set.reach == 0.01);
    CHECK(query.set.pairBegin.size() == 10);
    HostFixtures one = emptySet(5);
    one.spheres.add(dvec3(2.0), 0.04);
    CHECK(query(tool, Pose{}, 0.01, one).size() == 0);
    CHECK(query.set.frame == 5);
    CHECK(query.set.generation == 5);
    CHECK(query(tool, Pose{dvec3(2.0), kUpright}, 0.01, one).size() == 1);
    CHECK(query.cull.statistics().queries == 3);
    CHECK(query.cull.statistics().overflows == 0);
}

TEST_CASE("Radii of 0.1 mm to 10 m in one cloud are all found") {
    std::mt19937_64 random(15);
    const HostFixtures fixtures = randomCloud(random, 2000, 12.0, 1e-4, 10.0);
    const Tool tool = randomTool(random, 20, 0.3, 0.02);
    Query query;
    for (int k = 0; k < 10; ++k) {
        const Pose pose{randomIn(random, 12.0), randomRotation(random)};
        const ContactSet& set = query(tool, pose, 0.01, fixtures);
        CHECK(set.source == oracleSources(tool, pose, 0.01, fixtures));
        checkPairs(tool, pose, fixtures, set);
    }
}

TEST_CASE("An overflow halves the reach until the result fits, certifies it, and doubles the next capacity") {
    std::mt19937_64 random(16);
    HostFixtures fixtures = emptySet();
    addWall(fixtures, dvec3(0.0), dvec3(1, 0, 0), dvec3(0, 1, 0), 0.1, 0.002, 0.01);
    const Tool tool = ballTool(0.01);
    const Pose pose{dvec3(0, 0, 0.021), kUpright}; // 1 mm above the wall
    SUBCASE("by spheres") {
        Query query({40, 1000000});
        const ContactSet& set = query(tool, pose, 0.016, fixtures);
        CHECK(set.size() <= 40);
        CHECK(set.reach < 0.016);
        CHECK(std::exp2(std::round(std::log2(0.016 / set.reach))) == doctest::Approx(0.016 / set.reach));
        CHECK(set.source == oracleSources(tool, pose, set.reach, fixtures));
        CHECK(oracleSources(tool, pose, 2.0 * set.reach, fixtures).size() > 40);
        checkPairs(tool, pose, fixtures, set);
        CHECK(query.cull.statistics().overflows == 1);
        CHECK(query.cull.capacity().spheres == 80);
    }
    SUBCASE("by pairs") {
        Query query({1000000, 40});
        const ContactSet& set = query(tool, pose, 0.016, fixtures);
        CHECK(set.pairSphere.size() <= 40);
        CHECK(set.source == oracleSources(tool, pose, set.reach, fixtures));
        checkPairs(tool, pose, fixtures, set);
        CHECK(query.cull.capacity().pairs == 80);
    }
    SUBCASE("until it fits without overflow") {
        Query query({40, 1000000});
        double last = 0.0;
        for (int k = 0; k < 12; ++k) {
            last = query(tool, pose, 0.016, fixtures).reach;
        }
        CHECK(last == 0.016);
        CHECK(query.cull.statistics().overflows < 8);
    }
    SUBCASE("touching spheres that do not fit raise the capacity at once") {
        Query query({8, 8});
        const Pose deep{dvec3(0, 0, 0.012), kUpright};
        const ContactSet& set = query(tool, deep, 0.016, fixtures);
        CHECK(set.size() > 8);
        CHECK(set.source == oracleSources(tool, deep, set.reach, fixtures));
        checkPairs(tool, deep, fixtures, set);
    }
}
