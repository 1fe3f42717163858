// SPDX-License-Identifier: Apache-2.0
// The views about the tool from the side and from above.
#include "apps/operate/close_up.h"
#include "tests/apps/flat_wall.h"

#include <cmath>
#include <doctest/doctest.h>
#include <glm/geometric.hpp>
#include <limits>

using namespace fathom;
using namespace fathom::operate;

namespace {

constexpr PixelRect kCloseUpRoom{100, 50, 200, 200};

CloseUp viewOf(const HostFixtures& set, const std::vector<Sphere>& tool, CloseUpSide side) {
    const auto view =
        closeUp(set, depthCues(set, tool, std::numeric_limits<double>::quiet_NaN()), side, kCloseUpRoom);
    REQUIRE(view);
    return *view;
}

} // namespace

TEST_CASE(
    "The side view has the camera at the left, the top view at the lower edge, both without perspective") {
    const HostFixtures set;
    const std::vector<Sphere> tool{{{0.0, 0.0, 0.5}, 0.01}};
    const CloseUp side = viewOf(set, tool, CloseUpSide::Right), top = viewOf(set, tool, CloseUpSide::Top);
    const double pixels = 200.0 / (2.0 * side.reach);
    const auto off = [&](const CloseUp& view, const dvec3& by) {
        const ImVec2 middle = *view.port.of({0.0, 0.0, 0.5}), at = *view.port.of(dvec3(0.0, 0.0, 0.5) + by);
        return glm::dvec2(at.x - middle.x, at.y - middle.y) / pixels;
    };
    CHECK(std::abs(side.port.of({0.0, 0.0, 0.5})->x - 200.0f) < 1.0f);
    const auto same = [](const glm::dvec2& a, double x, double y) {
        return std::abs(a.x - x) < 5e-4 && std::abs(a.y - y) < 5e-4;
    };
    CHECK(same(off(side, {0.0, 0.0, 0.05}), 0.05, 0.0)); // away from the camera: to the right
    CHECK(same(off(side, {0.0, 0.05, 0.0}), 0.0, 0.05)); // down
    CHECK(same(off(side, {0.1, 0.0, 0.05}), 0.05, 0.0)); // towards the eye
    CHECK(same(off(top, {0.0, 0.0, 0.05}), 0.0, -0.05)); // away from the camera: up
    CHECK(same(off(top, {0.05, 0.0, 0.0}), 0.05, 0.0));
    CHECK(same(off(top, {0.0, -0.1, 0.05}), 0.0, -0.05));
    CHECK_FALSE(closeUp(set, DepthCues(), CloseUpSide::Top, kCloseUpRoom));
}

TEST_CASE(
    "The section shows the regions in the plane through the tool's nearest point, at their true distance") {
    HostFixtures set;
    addRegion(set, {0.0, 0.0, 0.08}, 0.03, 0);  // in front of the tool
    addRegion(set, {0.06, 0.0, 0.06}, 0.03, 0); // next to the plane of the side view
    const CloseUp side = viewOf(set, {{{0.0, 0.0, 0.0}, 0.01}}, CloseUpSide::Right);
    REQUIRE(side.section.size() == 1);
    CHECK(side.section[0].radius == doctest::Approx(0.03));
    CHECK(glm::distance(side.section[0].centre, dvec3(0.0, 0.0, 0.08)) < 1e-6);
    const CloseUp top = viewOf(set, {{{0.0, 0.0, 0.0}, 0.01}}, CloseUpSide::Top);
    CHECK(top.section.size() == 2);
    const CloseUp higher = viewOf(set, {{{0.0, -0.02, 0.07}, 0.001}}, CloseUpSide::Top);
    for (const Sphere& s : higher.section) { // the plane is 20 mm above their centres, or a little less
        CHECK(s.radius < 0.024);
        CHECK(s.radius > 0.0223);
    }
}

TEST_CASE("The view is larger than the tool, and a surface of the camera shows where the plane cuts it") {
    const HostFixtures set = flatWall(); // 1 m away
    const CloseUp small = viewOf(set, {{{0.0, 0.0, 0.95}, 0.01}}, CloseUpSide::Right);
    CHECK(small.reach == doctest::Approx(0.12));
    REQUIRE(!small.surface.empty());
    for (const dvec3& point : small.surface) {
        CHECK(point.z == doctest::Approx(1.0).epsilon(0.01));
        CHECK(std::abs(point.x) <= 0.01);
    }
    const std::vector<Sphere> rod{{{0.0, 0.0, 0.7}, 0.01}, {{0.0, 0.0, 0.9}, 0.01}};
    CHECK(viewOf(set, rod, CloseUpSide::Top).reach == doctest::Approx(0.19));
    const std::vector<Sphere> arm{{{0.0, 0.0, 0.2}, 0.03}, {{0.0, 0.0, 0.9}, 0.03}};
    CHECK(viewOf(set, arm, CloseUpSide::Top).reach == doctest::Approx(0.12)); // of its end
}

TEST_CASE("The views take the room left of the gap bar, or above it, and none where it is too small") {
    PixelRect gap{600, 60, 266, 418};
    const CloseUpRooms rooms = closeUpRooms(gap, 1.0f);
    CHECK(rooms.side.width >= 150);
    CHECK(rooms.side.y + rooms.side.height <= rooms.top.y);
    CHECK(rooms.top.y + rooms.top.height <= 60 + 418);
    CHECK(gap.x >= rooms.side.x + rooms.side.width);
    CHECK(gap.width >= 84);
    PixelRect flat{0, 0, 500, 160};
    const CloseUpRooms beside = closeUpRooms(flat, 1.0f);
    CHECK(beside.top.x >= beside.side.x + beside.side.width);
    PixelRect column{744, 64, 154, 500}; // of a window of 1280x800
    const CloseUpRooms above = closeUpRooms(column, 1.0f);
    CHECK(above.side.width >= 140);
    CHECK(above.top.y >= above.side.y + above.side.height);
    CHECK(column.y >= above.top.y + above.top.height);
    CHECK(column.y + column.height == 564);
    CHECK(column.height >= 200);
    PixelRect narrow{0, 0, 120, 300};
    CHECK(closeUpRooms(narrow, 1.0f).side.width == 0);
    CHECK(narrow.width == 120);
}
