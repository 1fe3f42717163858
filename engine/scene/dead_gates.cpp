// SPDX-License-Identifier: Apache-2.0
#include "engine/scene/dead_gates.h"

#include "engine/types/joined.h"
#include "engine/types/printed.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <utility>

namespace fathom {

namespace {

constexpr double kFewValues = 30.0; // of depth between near and far
constexpr double kMaxRaw = 65535.0;
constexpr double kFewDegrees = 1.0; // that a gate passes which wraps through 0

// Length of the longest ray of the image per metre of depth. Infinite for a distorted lens.
double longestRay(const Intrinsics& lens) {
    if (lens.distorted()) {
        return HUGE_VAL;
    }
    double longest = 1.0;
    for (const double u : {0.0, lens.width - 1.0}) {
        for (const double v : {0.0, lens.height - 1.0}) {
            longest = std::max(longest, glm::length(dvec3(lens.ray(u, v), 1.0)));
        }
    }
    return longest;
}

// Why no colour passes; empty = some does.
std::string deadColour(const FixtureClass& f, const CameraInfo& camera) {
    const bool needsColour = f.hue || (f.saturation && f.saturation->lo > 0.0);
    if (f.usesColour() && !camera.hasColour) {
        return "it has a colour gate, and the camera has no colour";
    }
    if (f.hue && f.saturation && f.saturation->hi <= 0.0) {
        return "a pixel of saturation 0 has no hue";
    }
    if (needsColour && f.lightness && (f.lightness->hi <= 0.0 || f.lightness->lo >= 1.0)) {
        return "a black or white pixel has neither hue nor saturation";
    }
    return "";
}

std::string deadRange(const FixtureClass& f, const Scene& scene, const CameraInfo& camera) {
    const double farthest = scene.farZ * longestRay(camera.depth);
    if (f.range && (f.range->hi < scene.nearZ || f.range->lo > farthest)) {
        return printed("its range of %.6g to %.6g m", f.range->lo, f.range->hi) +
               printed(" lies outside of camera.near %.6g to camera.far %.6g m", scene.nearZ, scene.farZ);
    }
    return "";
}

// Keys of the other role whose values are not the defaults.
std::vector<std::string> otherKeys(const FixtureClass& f) {
    const FixtureClass standard;
    const bool forbidden = f.role == Role::Forbidden;
    std::vector<std::string> keys;
    for (const auto& [key, changed] :
         {std::pair("radius", !forbidden && f.radius != standard.radius),
          std::pair("standoff", forbidden && f.standoff != standard.standoff),
          std::pair("quat_xyzw", forbidden && f.orientation != standard.orientation),
          std::pair("min_count", forbidden && f.minCount != standard.minCount),
          std::pair("largest_part", forbidden && f.largestPart != standard.largestPart),
          std::pair("trim", forbidden && f.trim != standard.trim)}) {
        if (changed) {
            keys.push_back(key);
        }
    }
    return keys;
}

} // namespace

std::vector<std::string> unusedKeys(const Scene& scene) {
    std::vector<std::string> notes;
    for (const FixtureClass& f : scene.fixtures) {
        const std::vector<std::string> keys = f.isPoints() ? otherKeys(f) : std::vector<std::string>{};
        if (!keys.empty()) {
            notes.push_back("fixture '" + f.name + "': " + joined(keys) + ": no effect with role " +
                            (f.role == Role::Forbidden ? "forbidden, only with guidance"
                                                       : "guidance, only with forbidden"));
        }
    }
    return notes;
}

std::vector<std::string> hueNotes(const Scene& scene) {
    std::vector<std::string> notes;
    for (const FixtureClass& f : scene.fixtures) {
        if (!f.isPoints() || !f.hue || f.name.empty()) {
            continue;
        }
        const auto [lo, hi] = *f.hue;
        const std::string named = "fixture '" + f.name + "': hue " + printed("[%.6g, %.6g]", lo, hi);
        if (lo == hi) {
            notes.push_back(named + " passes one hue only, not a range");
        } else if (lo > hi && hi + 360.0 - lo < kFewDegrees) {
            notes.push_back(named + " wraps through 0 and passes " + printed("%.3g", hi + 360.0 - lo) +
                            " degrees only; " + printed("[%.6g, %.6g]", hi, lo) + " passes the others");
        } else if (std::max(lo, hi) <= 1.0) {
            notes.push_back(named + " is in degrees, 0 to 360" +
                            printed("; if it is a share of 1, give [%.6g, %.6g]", 360.0 * lo, 360.0 * hi));
        }
    }
    return notes;
}

std::vector<std::string> equalityNotes(const Scene& scene) {
    std::vector<std::string> notes;
    for (const FixtureClass& f : scene.fixtures) {
        if (f.isEquality()) {
            notes.push_back(
                "fixture '" + f.name + "': " + (f.shape == ShapeKind::Line ? "a line" : "an axis") +
                " holds the tool with any role, whenever forces are on: no button switches it, and "
                "guidance_pull does not limit it");
        }
    }
    return notes;
}

std::vector<std::string> deadGates(const Scene& scene, const CameraInfo& camera) {
    std::vector<std::string> dead;
    bool points = false;
    for (const FixtureClass& f : scene.fixtures) {
        if (!f.isPoints() || f.name.empty()) { // a spare class of the window has no name
            continue;
        }
        points = true;
        std::string cause = deadColour(f, camera);
        cause = cause.empty() ? deadRange(f, scene, camera) : cause;
        if (!cause.empty()) {
            dead.push_back("fixture '" + f.name + "' can have no point: " + cause);
        }
    }
    const double unit = camera.metresPerUnit;
    const double values =
        std::floor(std::min(scene.farZ / unit, kMaxRaw)) - std::ceil(scene.nearZ / unit) + 1.0;
    if (points && values < kFewValues) {
        dead.push_back(
            printed("a depth unit of %.6g m leaves %.0f depth values", unit, std::max(0.0, values)) +
            printed(" between camera.near %.6g and camera.far %.6g m", scene.nearZ, scene.farZ));
    }
    return dead;
}

} // namespace fathom
