// SPDX-License-Identifier: Apache-2.0
#include "engine/types/camera_info.h"
#include "engine/types/pose.h"
#include "engine/types/sphere_tree.h"

#include <cmath>
#include <doctest/doctest.h>

using namespace fathom;

TEST_CASE("The logarithm of a rotation inverts its exponential from 1e-12 rad to just under pi") {
    const dvec3 axis = glm::normalize(dvec3(1.0, -2.0, 0.5));
    for (double angle : {1e-12, 1e-7, 1e-3, 0.5, 2.0, 3.14159}) {
        const dvec3 v = rotationLog(rotationExp(axis * angle));
        CHECK(glm::length(v - axis * angle) <= 1e-9 * angle);
        CHECK(glm::length(rotationLog(-rotationExp(axis * angle)) - axis * angle) <= 1e-9 * angle);
    }
    CHECK(rotationLog(dquat(1, 0, 0, 0)) == dvec3(0.0));
}

TEST_CASE("A pose times its inverse is the identity and half-way interpolation halves the arc") {
    const Pose a{{1, 2, 3}, rotationExp({0.3, -0.2, 1.0})};
    const Pose id = a * inverse(a);
    CHECK(glm::length(id.position) < 1e-14);
    CHECK(glm::length(rotationLog(id.rotation)) < 1e-14);
    const Pose mid = interpolate(Pose{}, Pose{{2, 0, 0}, rotationExp({0, 0, 1})}, 0.5);
    CHECK(mid.position.x == doctest::Approx(1.0));
    CHECK(rotationLog(mid.rotation).z == doctest::Approx(0.5));
}

TEST_CASE("Ray and project invert each other through the freiburg1 lens over the whole image") {
    const Intrinsics lens{640, 480, 517.3, 516.5, 318.6, 255.3, {0.2624, -0.9531, -0.0054, 0.0026, 1.1633}};
    double worst = 0.0;
    for (uint32_t v = 0; v < lens.height; v += 13) {
        for (uint32_t u = 0; u < lens.width; u += 7) {
            const glm::dvec2 r = lens.ray(u, v);
            worst =
                std::max(worst, glm::distance(lens.project({2.0 * r.x, 2.0 * r.y, 2.0}), glm::dvec2(u, v)));
        }
    }
    CHECK(worst < 1e-9);
}

TEST_CASE("A sphere tree of any leaf count encloses its leaves and keeps every one") {
    for (size_t count : {1u, 2u, 3u, 7u, 64u, 100u}) {
        std::vector<Sphere> leaves;
        for (size_t i = 0; i < count; ++i) {
            const double a = static_cast<double>(i);
            leaves.push_back({{std::sin(a), std::cos(2 * a), 0.1 * a}, 0.01 + 0.001 * a});
        }
        const SphereTree tree = buildSphereTree(leaves);
        CHECK(validate(tree) == "");
        size_t used = 0;
        for (const Sphere& s : tree.lastLevel()) {
            used += s.radius > 0.0;
        }
        CHECK(used == count);
    }
}

TEST_CASE("The tree validator names a child that sticks out") {
    SphereTree tree = buildSphereTree(std::vector<Sphere>{{{0, 0, 0}, 1}, {{3, 0, 0}, 1}});
    tree.nodes[1].radius = 5.0;
    CHECK(validate(tree) == "node 0 does not enclose its child 1");
}

TEST_CASE("The rotation between two orientations turns the first into the second, by the shorter arc") {
    const dquat from = rotationExp({0.3, -0.2, 1.0});
    const dquat to = rotationExp({0.1, 0.5, -0.4}) * from;
    CHECK(glm::length(rotationBetween(from, to) - dvec3(0.1, 0.5, -0.4)) < 1e-14);
    CHECK(glm::length(rotationBetween(from, -to) - dvec3(0.1, 0.5, -0.4)) < 1e-14);
}
