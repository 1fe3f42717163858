// SPDX-License-Identifier: Apache-2.0
#include "engine/model/cover_links.h"

#include "engine/model/arm_model.h"
#include "tests/model/meshes.h"
#include "tests/support/refusal.h"

#include <algorithm>
#include <doctest/doctest.h>
#include <unistd.h>

using namespace fathom;

namespace {

LinkGeometry meshLink(const std::string& link, const std::filesystem::path& file) {
    const auto mesh = std::make_shared<urdf::Mesh>();
    mesh->filename = file.string();
    mesh->scale = urdf::Vector3(1.0, 1.0, 1.0);
    return {link, mesh};
}

LinkGeometry ballShape(const std::string& link, double radius) {
    const auto ball = std::make_shared<urdf::Sphere>();
    ball->radius = radius;
    return {link, ball};
}

std::string spheresRefusal(const std::vector<LinkGeometry>& shapes) {
    return testing::refusalOf([&] { spheresOf(shapes, {"arm.urdf", {}}, 8); });
}

} // namespace

TEST_CASE("Equal meshes get equal spheres, at most as many as asked for") {
    const testing::ObjFile one(testing::boxMesh(dvec3(0.0), dvec3(0.1)));
    const std::vector<LinkGeometry> shapes(6, meshLink("a", one.path()));
    const std::vector<ShapeSpheres> made = spheresOf(shapes, {"arm.urdf", {}}, 8);
    REQUIRE(made.size() == 6);
    for (const ShapeSpheres& each : made) {
        CHECK(each.spheres.size() == made[0].spheres.size());
        CHECK(each.spheres.size() > 1);
        CHECK(each.spheres.size() <= 8);
    }
}

TEST_CASE(
    "Shapes keep their order, and the first of several rejections is reported, of a file or of a size; a "
    "shape of size 0 is skipped") {
    const testing::ObjFile one(testing::boxMesh(dvec3(0.0), dvec3(0.1)));
    const auto made =
        spheresOf(std::vector{ballShape("a", 0.1), meshLink("b", one.path()), ballShape("c", 0.3)},
                  {"arm.urdf", {}}, 8);
    REQUIRE(made.size() == 3);
    CHECK(made[0].spheres[0].radius == 0.1);
    CHECK(made[1].spheres.size() > 1);
    CHECK(made[2].spheres[0].radius == 0.3);
    CHECK(spheresOf({}, {"arm.urdf", {}}, 8).empty());

    const LinkGeometry noFile = meshLink("none", "/nowhere/none.obj"), noSize = ballShape("flat", -0.1);
    CHECK(spheresRefusal({ballShape("a", 0.1), noSize, noFile}).find("arm.urdf: link flat: ") == 0);
    CHECK(spheresRefusal({ballShape("a", 0.1), noFile, noSize})
              .find("arm.urdf: link none: mesh '/nowhere/none.obj'") == 0);
    const auto skipped = spheresOf(std::vector{ballShape("flat", 0.0)}, {"arm.urdf", {}}, 8);
    REQUIRE(skipped.size() == 1);
    CHECK(skipped[0].spheres.empty());
    CHECK(skipped[0].notes == std::vector<std::string>{"a shape of size 0 is skipped"});
}

TEST_CASE("A plate, disc or rod with one size of 0 is covered, with a note") {
    const auto plate = std::make_shared<urdf::Box>();
    plate->dim = urdf::Vector3(0.1, 0.1, 0.0);
    const auto line = std::make_shared<urdf::Box>();
    line->dim = urdf::Vector3(0.0, 0.0, 0.3);
    const auto disc = std::make_shared<urdf::Cylinder>(), rod = std::make_shared<urdf::Cylinder>();
    disc->radius = 0.1;
    disc->length = 0.0;
    rod->radius = 0.0;
    rod->length = 0.3;
    const std::vector<LinkGeometry> shapes{{"plate", plate}, {"line", line}, {"disc", disc}, {"rod", rod}};
    const std::vector<std::vector<dvec3>> inside{{{0.05, 0.05, 0.0}, {-0.05, 0.05, 0.0}, {0.01, 0.02, 0.0}},
                                                 {{0.0, 0.0, 0.15}, {0.0, 0.0, -0.07}},
                                                 {{0.1, 0.0, 0.0}, {0.0, -0.1, 0.0}, {0.03, 0.02, 0.0}},
                                                 {{0.0, 0.0, 0.15}, {0.0, 0.0, -0.07}}};
    const auto made = spheresOf(shapes, {"arm.urdf", {}}, 24);
    for (size_t i = 0; i < shapes.size(); ++i) {
        CAPTURE(shapes[i].link);
        CHECK(made[i].notes ==
              std::vector<std::string>{"a shape with a size of 0 is covered as a surface or line"});
        for (const dvec3& p : inside[i]) {
            CHECK(std::ranges::any_of(made[i].spheres, [&](const Sphere& s) {
                return glm::distance(s.centre, p) <= s.radius + 1e-9;
            }));
        }
    }
}
