// SPDX-License-Identifier: Apache-2.0
#include "engine/contact/shapes.h"

#include "tests/contact/clouds.h"

#include <cmath>
#include <doctest/doctest.h>
#include <limits>

using namespace fathom;
using namespace fathom::testing;

namespace {

Shape shapeOf(ShapeKind kind, const dvec3& size, bool keepIn, const Pose& pose) {
    Shape shape;
    shape.kind = kind;
    shape.size = size;
    shape.keepIn = keepIn;
    shape.baseTshape = pose;
    return shape;
}

bool isInside(const Shape& shape, const dvec3& p) { // shape frame
    switch (shape.kind) {
    case ShapeKind::Sphere:
        return glm::length(p) < shape.size.x;
    case ShapeKind::Box:
        return std::abs(p.x) < 0.5 * shape.size.x && std::abs(p.y) < 0.5 * shape.size.y &&
               std::abs(p.z) < 0.5 * shape.size.z;
    case ShapeKind::Cylinder:
        return std::hypot(p.x, p.y) < shape.size.x && std::abs(p.z) < 0.5 * shape.size.y;
    default:
        return p.z < 0.0;
    }
}

const ShapeKind kSolids[] = {ShapeKind::Sphere, ShapeKind::Box, ShapeKind::Plane, ShapeKind::Cylinder};

} // namespace

TEST_CASE("The gap of every solid is a true signed distance: correct sign, slope one along its normal, never "
          "steeper") {
    std::mt19937_64 random(41);
    for (const ShapeKind kind : kSolids) {
        const Pose pose{randomIn(random, 1.0), randomRotation(random)};
        for (const bool keepIn : {false, true}) {
            const Shape shape = shapeOf(kind, dvec3(0.3, 0.5, 0.2), keepIn, pose);
            for (int k = 0; k < 2000; ++k) {
                const dvec3 local = randomIn(random, 0.5);
                const dvec3 p = pose.apply(local), q = pose.apply(randomIn(random, 0.5));
                const SideGap side = gapTo(shape, p, 0.0);
                REQUIRE(glm::length(side.normal) == doctest::Approx(1.0).epsilon(1e-9));
                REQUIRE((side.gap < 0.0) == (isInside(shape, local) != keepIn));
                // Moving back by the gap along the normal ends on the surface.
                REQUIRE(std::abs(gapTo(shape, p - side.gap * side.normal, 0.0).gap) < 1e-9);
                REQUIRE(std::abs(side.gap - gapTo(shape, q, 0.0).gap) <= glm::distance(p, q) + 1e-12);
                REQUIRE(gapTo(shape, p, 0.02).gap == doctest::Approx(side.gap - 0.02).epsilon(1e-9));
            }
        }
    }
}

TEST_CASE("The smallest gap of the sides of a keep-in solid equals its own gap") {
    std::mt19937_64 random(42);
    for (const ShapeKind kind : kSolids) {
        const Shape shape =
            shapeOf(kind, dvec3(0.3, 0.5, 0.2), true, {randomIn(random, 1.0), randomRotation(random)});
        for (int k = 0; k < 500; ++k) {
            const dvec3 p = shape.baseTshape.apply(randomIn(random, 0.4));
            std::array<SideGap, kMaxSides> sides;
            const size_t count = sidesOf(shape, p, 0.01, sides);
            REQUIRE(count >= 1);
            double least = std::numeric_limits<double>::infinity();
            for (size_t s = 0; s < count; ++s) {
                least = std::min(least, sides[s].gap);
            }
            const double gap = gapTo(shape, p, 0.01).gap;
            REQUIRE((least >= 0.0) == (gap >= 0.0));
            if (gap > -0.01) { // the centre itself is inside: then the nearest side is the gap
                REQUIRE(least == doctest::Approx(gap).epsilon(1e-9));
            }
        }
    }
}

TEST_CASE("The centre of a sphere and the axis of a cylinder have a normal") {
    for (const ShapeKind kind : kSolids) {
        const SideGap side = gapTo(shapeOf(kind, dvec3(0.2, 0.2, 0.2), false, Pose{}), dvec3(0.0), 0.01);
        CHECK(glm::length(side.normal) == doctest::Approx(1.0));
        CHECK(std::isfinite(side.gap));
    }
}

TEST_CASE(
    "A line requests the motion across, an axis also the rotation onto it, and neither any when satisfied") {
    std::mt19937_64 random(43);
    const Pose pose{randomIn(random, 1.0), randomRotation(random)};
    const Shape line = shapeOf(ShapeKind::Line, dvec3(0.0), false, pose);
    const Shape axis = shapeOf(ShapeKind::Axis, dvec3(0.0), false, pose);
    std::array<Equality, kMaxEqualities> rows;
    const Pose on{pose.apply(dvec3(0, 0, 0.7)), pose.rotation * rotationExp(dvec3(0, 0, 1.3))};
    CHECK(equalitiesOf(line, on, rows) == 2);
    CHECK(equalitiesOf(axis, on, rows) == 4);
    for (const Equality& row : rows) {
        CHECK(std::abs(row.error) < 1e-12);
    }
    const Pose off{pose.apply(dvec3(0.03, -0.02, 0.7)),
                   rotationExp(pose.rotation * dvec3(0.2, 0.1, 0)) * on.rotation};
    equalitiesOf(axis, off, rows);
    dvec3 a{0.0}, alpha{0.0};
    for (const Equality& row : rows) {
        a -= row.error * row.linear;
        alpha -= row.error * row.angular;
    }
    CHECK(glm::distance(off.position + a, on.position) < 1e-12);
    const dvec3 z = rotationExp(alpha) * off.rotation * dvec3(0, 0, 1);
    CHECK(glm::distance(z, pose.rotation * dvec3(0, 0, 1)) < 1e-12);
    const Pose opposite{on.position, on.rotation * dquat(0.0, 1.0, 0.0, 0.0)};
    equalitiesOf(axis, opposite, rows);
    CHECK(std::hypot(rows[2].error, rows[3].error) == doctest::Approx(M_PI));
}

TEST_CASE("The shapes of a scene are its rows with a shape, in file order, with unit rotations") {
    Scene scene;
    CHECK(shapesOf(scene).empty());
    scene.fixtures.resize(3);
    scene.fixtures[1].shape = ShapeKind::Box;
    scene.fixtures[1].keepIn = true;
    scene.fixtures[2].shape = ShapeKind::Line;
    scene.fixtures[2].baseTshape.rotation = dquat(2.0, 0.0, 0.0, 0.0);
    const std::vector<Shape> shapes = shapesOf(scene);
    REQUIRE(shapes.size() == 2);
    CHECK(shapes[0].fixture == 1);
    CHECK(shapes[0].keepIn);
    CHECK(shapes[1].isEquality());
    CHECK(shapes[1].baseTshape.rotation.w == 1.0);
}
