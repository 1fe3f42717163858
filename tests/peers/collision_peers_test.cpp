// SPDX-License-Identifier: Apache-2.0
// Checks the other libraries' answers on spheres within reach of a tool against all pairs in float64.
#include "apps/profile/peers/nearby_oracle.h"
#include "apps/profile/peers/peers.h"

#include <doctest/doctest.h>
#include <limits>
#include <random>

using namespace fathom;
using namespace fathom::peers;

namespace {

struct World {
    RegionSpheres spheres;
    PosedLeaves leaves;

    void sphere(float x, float y, float z, float r) {
        spheres.x.push_back(x), spheres.y.push_back(y), spheres.z.push_back(z);
        spheres.radius.push_back(r);
    }
    void leaf(float x, float y, float z, float r) {
        leaves.x.push_back(x), leaves.y.push_back(y), leaves.z.push_back(z);
        leaves.radius.push_back(r);
    }
};

World randomWorld(size_t spheres, size_t leaves, bool equalRadii, unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> place(-0.5f, 0.5f), size(0.005f, 0.04f);
    World world;
    for (size_t i = 0; i < spheres; ++i) {
        const float x = place(random), y = place(random), z = place(random);
        world.sphere(x, y, z, equalRadii ? 0.02f : size(random));
    }
    for (size_t i = 0; i < leaves; ++i) {
        const float x = place(random), y = place(random), z = place(random);
        world.leaf(x, y, z, size(random));
    }
    return world;
}

// Runs every method on one world and returns the last result.
std::vector<uint32_t> checkAll(const World& world, float reach) {
    const auto gaps = nearbyGaps(world.spheres, world.leaves, reach);
    std::vector<uint32_t> found;
    for (const auto& way : collisionMethods()) {
        CAPTURE(way.name);
        const auto peer = way.make();
        peer->build(world.spheres);
        peer->query(world.leaves, reach, found);
        CHECK(disagreement(gaps, found).differ == 0);
        const auto first = found;
        peer->query(world.leaves, reach, found); // no results of the previous query remain
        CHECK(found == first);
    }
    return found;
}

} // namespace

TEST_CASE("Every library finds nothing without spheres or without leaves") {
    CHECK(checkAll(World{}, 0.01f).empty());
    CHECK(checkAll(randomWorld(0, 5, true, 1), 0.01f).empty());
    CHECK(checkAll(randomWorld(37, 0, true, 2), 0.01f).empty());
}

TEST_CASE("Every library finds a sphere within the reach and none beyond it") {
    World world;
    world.sphere(0.1f, 0.2f, 0.9f, 0.02f);
    world.leaf(0.1f, 0.2f, 0.9f - 0.0349f, 0.005f); // gap 9.9 mm
    CHECK(checkAll(world, 0.01f) == std::vector<uint32_t>{0});
    world.leaves.z[0] = 0.9f - 0.0351f; // 10.1 mm
    CHECK(checkAll(world, 0.01f).empty());
}

TEST_CASE("A sphere in the corner of a leaf's bounding box is not within reach") {
    World world;
    world.sphere(0.03f, 0.03f, 0.03f, 0.02f); // 52 mm away, boxes overlap
    world.leaf(0.0f, 0.0f, 0.0f, 0.01f);
    CHECK(checkAll(world, 0.01f).empty());
}

TEST_CASE("Every library finds each sphere once when all are within reach") {
    World world = randomWorld(301, 7, false, 3);
    CHECK(checkAll(world, 2.0f).size() == 301);
}

TEST_CASE("Every library finds both of two coinciding spheres") {
    World world;
    for (int i = 0; i < 40; ++i) { // more than any tree's leaf node holds
        world.sphere(0.0f, 0.0f, 0.5f, 0.01f);
    }
    world.leaf(0.0f, 0.0f, 0.47f, 0.015f);
    CHECK(checkAll(world, 0.01f).size() == 40);
}

TEST_CASE("Every library agrees with float64 on random worlds of many sizes") {
    unsigned seed = 10;
    for (const size_t spheres : {1, 2, 15, 17, 333, 2049}) {
        for (const size_t leaves : {1, 3, 65}) {
            for (const bool equal : {true, false}) {
                CAPTURE(spheres);
                CAPTURE(leaves);
                checkAll(randomWorld(spheres, leaves, equal, ++seed), 0.03f);
            }
        }
    }
}

TEST_CASE("A rebuilt library forgets the previous spheres") {
    const World many = randomWorld(200, 3, true, 5), few = randomWorld(3, 3, true, 6), none;
    for (const auto& way : collisionMethods()) {
        CAPTURE(way.name);
        const auto peer = way.make();
        std::vector<uint32_t> found;
        for (const World* world : {&many, &few, &none, &many}) {
            peer->build(world->spheres);
            peer->query(many.leaves, 2.0f, found);
            CHECK(found.size() == world->spheres.size());
        }
    }
}

TEST_CASE("The reference counts missing, extra and repeated spheres, and counts ties separately") {
    const std::vector<double> gaps{-0.1, 0.1, 5e-7, -5e-7, -0.2};
    CHECK(disagreement(gaps, {0, 3, 4}).differ == 0);
    CHECK(disagreement(gaps, {0, 3, 4}).ties == 0);
    CHECK(disagreement(gaps, {4, 2, 0}).differ == 0);
    CHECK(disagreement(gaps, {4, 2, 0}).ties == 2);
    CHECK(disagreement(gaps, {0, 3}).differ == 1);        // 4 missing
    CHECK(disagreement(gaps, {0, 1, 3, 4}).differ == 1);  // 1 too many
    CHECK(disagreement(gaps, {0, 0, 3, 4}).differ == 1);  // 0 twice
    CHECK(disagreement(gaps, {0, 3, 4, 17}).differ == 1); // no such sphere
    World world;
    world.sphere(0.0f, 0.0f, 0.5f, 0.25f);
    CHECK(nearbyGaps(world.spheres, world.leaves, 0.125) ==
          std::vector<double>{std::numeric_limits<double>::infinity()});
    world.leaf(0.0f, 0.0f, 0.0f, 0.0625f);
    CHECK(nearbyGaps(world.spheres, world.leaves, 0.125)[0] == 0.0625);
}
