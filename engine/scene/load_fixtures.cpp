// SPDX-License-Identifier: Apache-2.0
// Section `fixtures` of a scene file: classes of points and placed shapes.
#include "engine/scene/load.h"

#include "shaders/shared/frame_params.h"

#include <algorithm>
#include <array>

namespace fathom {

namespace {

constexpr uint32_t kMaxPixels = 3840u * 2160u;

constexpr std::array<std::string_view, 12> kPointKeys{"hue",       "saturation", "lightness",    "intensity",
                                                      "range",     "box",        "radius",       "standoff",
                                                      "quat_xyzw", "min_count",  "largest_part", "trim"};
constexpr std::array<std::string_view, 2> kShapeKeys{"base_T_shape", "size"};

enum class RoleWord { Forbidden, Guidance, KeepIn };

std::optional<Band> loadBand(const YamlNode& row, std::string_view key, const Range& range, bool mayWrap) {
    const auto node = row.find(key);
    if (!node) {
        return std::nullopt;
    }
    const std::vector<YamlNode> ends = node->list(2);
    const Band band{ends[0].number(range), ends[1].number(range)};
    if (band.lo > band.hi && !mayWrap) {
        node->refuse("lo <= hi, each " + range.words());
    }
    return band;
}

Box loadBox(const YamlNode& node) {
    node.checkKeys({"min", "max"});
    const YamlNode min = node.at("min"), max = node.at("max");
    const Range corner = Range::between(-1e9, 1e9); // farther than any point: no limit on that side
    const Box box{min.vec3(corner), max.vec3(corner)};
    if (!glm::all(glm::lessThanEqual(box.min, box.max))) {
        node.refuse("min " + min.value() + ", max " + max.value(), "min <= max on every axis");
    }
    return box;
}

void loadPoints(const YamlNode& row, FixtureClass& fixture) {
    const Range share = Range::between(0.0, 1.0);
    fixture.hue = loadBand(row, "hue", Range::between(0.0, 360.0), true);
    fixture.saturation = loadBand(row, "saturation", share, false);
    fixture.lightness = loadBand(row, "lightness", share, false);
    fixture.range = loadBand(row, "range", Range::between(0.0, 1e4), false);
    if (const auto intensity = row.find("intensity")) { // sensors without colour deliver intensity as grey
        if (fixture.lightness) {
            intensity->refuse("instead of lightness, not with it");
        }
        fixture.lightness = loadBand(row, "intensity", share, false);
    }
    if (const auto box = row.find("box")) {
        fixture.box = loadBox(*box);
    }
    row.read("radius", fixture.radius, Range::between(1e-4, 10.0));
    row.read("standoff", fixture.standoff, Range::between(-10.0, 10.0));
    row.read("quat_xyzw", fixture.orientation);
    row.read("min_count", fixture.minCount, 1, kMaxPixels);
    row.read("largest_part", fixture.largestPart);
    row.read("trim", fixture.trim, Range::between(0.0, 0.5));
}

// Number of components of `size` in use; these must be positive.
size_t usedSizes(ShapeKind shape) {
    switch (shape) {
    case ShapeKind::Sphere:
        return 1;
    case ShapeKind::Cylinder:
        return 2;
    case ShapeKind::Box:
        return 3;
    default:
        return 0;
    }
}

void loadShape(const YamlNode& row, FixtureClass& fixture) {
    if (const auto pose = row.find("base_T_shape")) {
        fixture.baseTshape = loadPose(*pose);
    }
    const size_t used = usedSizes(fixture.shape);
    const auto size = used > 0 ? row.at("size") : row.find("size");
    if (!size) {
        return;
    }
    fixture.size = size->vec3(Range::between(0.0, 1e4));
    const std::vector<YamlNode> items = size->list(3);
    for (size_t i = 0; i < used; ++i) {
        items[i].number(Range::between(1e-4, 1e4));
    }
}

// Reject keys of the other kind of fixture, which would be ignored silently.
void refuseKeys(const YamlNode& row, std::span<const std::string_view> keys, const std::string& allowed) {
    for (std::string_view key : keys) {
        if (const auto node = row.find(key)) {
            node->refuse(allowed);
        }
    }
}

void loadRole(const YamlNode& node, FixtureClass& fixture) {
    const RoleWord role = node.choice<RoleWord>({{"forbidden", RoleWord::Forbidden},
                                                 {"guidance", RoleWord::Guidance},
                                                 {"keep_in", RoleWord::KeepIn}});
    if (fixture.isPoints() && role == RoleWord::KeepIn) {
        node.refuse("forbidden or guidance for points; keep_in needs a shape");
    }
    if (!fixture.isPoints() && !fixture.isEquality() && role == RoleWord::Guidance) {
        node.refuse("forbidden or keep_in for this shape");
    }
    fixture.role = role == RoleWord::Guidance ? Role::Guidance : Role::Forbidden;
    fixture.keepIn = role == RoleWord::KeepIn;
}

FixtureClass loadRow(const YamlNode& row) {
    row.checkKeys({"name", "role", "hue", "saturation", "lightness", "intensity", "range", "box", "radius",
                   "standoff", "quat_xyzw", "min_count", "largest_part", "trim", "shape", "base_T_shape",
                   "size"});
    FixtureClass fixture;
    fixture.name = row.at("name").text();
    row.read("shape", fixture.shape,
             {{"sphere", ShapeKind::Sphere},
              {"box", ShapeKind::Box},
              {"plane", ShapeKind::Plane},
              {"cylinder", ShapeKind::Cylinder},
              {"line", ShapeKind::Line},
              {"axis", ShapeKind::Axis}});
    loadRole(row.at("role"), fixture);
    if (fixture.isPoints()) {
        refuseKeys(row, kShapeKeys, "only in a fixture with a shape");
        loadPoints(row, fixture);
    } else {
        refuseKeys(row, kPointKeys, "only in a fixture of points, without a shape");
        loadShape(row, fixture);
    }
    return fixture;
}

} // namespace

void loadFixtures(const YamlNode& fixtures, Scene& scene) {
    const std::vector<YamlNode> rows = fixtures.list();
    if (rows.size() > Scene::kMaxFixtures) {
        fixtures.refuse(std::to_string(rows.size()) + " rows",
                        "at most " + std::to_string(Scene::kMaxFixtures));
    }
    size_t pointClasses = 0;
    for (const YamlNode& row : rows) {
        FixtureClass fixture = loadRow(row);
        const auto sameName = [&](const FixtureClass& other) { return other.name == fixture.name; };
        if (std::any_of(scene.fixtures.begin(), scene.fixtures.end(), sameName)) {
            row.at("name").refuse("a name not used by an earlier row");
        }
        pointClasses += fixture.isPoints() ? 1 : 0;
        scene.fixtures.push_back(std::move(fixture));
    }
    if (pointClasses > shared::kMaxClasses) {
        fixtures.refuse(std::to_string(pointClasses) + " classes of points",
                        "at most " + std::to_string(shared::kMaxClasses));
    }
}

} // namespace fathom
