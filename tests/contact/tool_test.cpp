// SPDX-License-Identifier: Apache-2.0
#include "engine/contact/tool.h"

#include "engine/types/error.h"
#include "tests/contact/clouds.h"

#include <doctest/doctest.h>

using namespace fathom;
using namespace fathom::testing;

TEST_CASE("A tool has its leaves, its bounding radius and its gyration radius") {
    const Tool tool = makeTool({{dvec3(0.1, 0, 0), 0.01}, {dvec3(-0.1, 0, 0), 0.03}});
    CHECK(tool.leafCount() == 2);
    CHECK(tool.boundingRadius() == doctest::Approx(0.13).epsilon(1e-12));
    CHECK(tool.gyrationRadius() == doctest::Approx(0.1).epsilon(1e-12));
    CHECK(ballTool(0.02).gyrationRadius() == doctest::Approx(0.02).epsilon(1e-12));
}

TEST_CASE("Unused slots of the last level are not leaves") {
    std::mt19937_64 random(1);
    CHECK(randomTool(random, 5, 0.1, 0.01).leafCount() == 5);
    CHECK(randomTool(random, 4096, 0.1, 0.01).leafCount() == 4096);
}

TEST_CASE("A tool with no leaf, too many leaves, an invalid tree or a leaf that is not finite is rejected") {
    std::mt19937_64 random(2);
    CHECK_THROWS_AS(randomTool(random, 4097, 0.1, 0.01), Error);
    SphereTree empty{1, 2, {Sphere{}}};
    CHECK_THROWS_AS(Tool{empty}, Error);
    SphereTree unsound = buildSphereTree(std::vector<Sphere>{{dvec3(0.0), 0.01}, {dvec3(1.0), 0.01}});
    unsound.nodes[0].radius = 0.1;
    CHECK_THROWS_AS(Tool{unsound}, Error);
    SphereTree infinite{1, 2, {Sphere{dvec3(INFINITY), 0.1}}};
    CHECK_THROWS_AS(Tool{infinite}, Error);
}

TEST_CASE("Posed leaves stay accurate to micrometres when the base frame's origin is kilometres away") {
    std::mt19937_64 random(3);
    const Tool tool = randomTool(random, 37, 0.1, 0.01);
    const dvec3 origin(51234.5, -8765.25, 333.0);
    const Pose pose{origin + dvec3(0.25, -0.5, 0.125), randomRotation(random)};
    PosedLeaves leaves;
    poseLeaves(tool, pose, origin, leaves);
    REQUIRE(leaves.x.size() == 37);
    double worst = 0.0;
    for (size_t i = 0; i < leaves.x.size(); ++i) {
        const dvec3 exact = dvec3(0.25, -0.5, 0.125) + pose.rotation * tool.leaves()[i].centre;
        worst = std::max(worst, glm::distance(exact, dvec3(leaves.x[i], leaves.y[i], leaves.z[i])));
    }
    MESSAGE("worst rounding of a posed leaf [m]: " << worst);
    CHECK(worst < 1e-7);
}
