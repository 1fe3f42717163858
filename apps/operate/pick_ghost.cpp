// SPDX-License-Identifier: Apache-2.0
#include "apps/operate/pick_ghost.h"

#include "apps/operate/view_lines.h"
#include "engine/types/printed.h"

#include <algorithm>
#include <cmath>
#include <functional>

namespace fathom::operate {

namespace {

constexpr size_t kMaxGhosts = 1500; // spheres

// How far [m] the spheres reach over a sphere; negative: they do not touch it.
double coverOf(std::span<const Sphere> ghost, const Sphere& what) {
    double deepest = -1.0;
    for (const Sphere& g : ghost) {
        deepest = std::max(deepest, g.radius + what.radius - glm::distance(g.centre, what.centre));
    }
    return deepest;
}

} // namespace

std::vector<Sphere> ghostOf(const HostFixtures& set, std::span<const uint8_t> selection, double radius) {
    const Intrinsics& lens = set.camera.depth;
    std::vector<Sphere> ghost;
    if (selection.size() != lens.pixels() || set.depth.size() != selection.size()) {
        return ghost;
    }
    const auto points = static_cast<size_t>(std::count(selection.begin(), selection.end(), uint8_t{1}));
    const auto step = static_cast<uint32_t>(
        std::ceil(std::sqrt(static_cast<double>(points) / static_cast<double>(kMaxGhosts))));
    for (uint32_t v = 0; v < lens.height; v += std::max(1u, step)) {
        for (uint32_t u = 0; u < lens.width; u += std::max(1u, step)) {
            const size_t i = static_cast<size_t>(v) * lens.width + u;
            if (selection[i] != 0 && set.depth[i] != 0) {
                const double z = set.depth[i] * set.camera.metresPerUnit;
                ghost.push_back({set.baseTcamera.apply(z * dvec3(lens.ray(u, v), 1.0)), radius});
            }
        }
    }
    return ghost;
}

namespace {

// cover: how far [m] the regions reach over a sphere; negative: they do not touch it.
std::vector<std::string> warningsOf(const std::function<double(const Sphere&)>& cover,
                                    std::span<const Sphere> tool, std::span<const GuidancePose> targets,
                                    const Scene& scene) {
    std::vector<std::string> warnings;
    double deepest = -1.0;
    for (const Sphere& s : tool) {
        deepest = std::max(deepest, cover(s));
    }
    if (deepest > 0.0) {
        warnings.push_back(printed("covers the tool: it will be pushed out %.0f mm", 1e3 * deepest));
    }
    for (const GuidancePose& g : targets) {
        if (g.present && g.fixture < scene.fixtures.size() && cover({g.target.position, 0.0}) > 0.0) {
            warnings.push_back("covers the target '" + scene.fixtures[g.fixture].name + "'");
        }
    }
    return warnings;
}

} // namespace

std::vector<std::string> coverWarnings(std::span<const Sphere> ghost, std::span<const Sphere> tool,
                                       std::span<const GuidancePose> targets, const Scene& scene) {
    return warningsOf([&](const Sphere& s) { return coverOf(ghost, s); }, tool, targets, scene);
}

std::vector<std::string> coverWarnings(const Shape& shape, std::span<const Sphere> tool,
                                       std::span<const GuidancePose> targets, const Scene& scene) {
    if (shape.isEquality() || shape.keepIn) {
        return {};
    }
    return warningsOf([&](const Sphere& s) { return -gapTo(shape, s.centre, s.radius).gap; }, tool, targets,
                      scene);
}

void drawGhost(ImDrawList& list, const ViewPort& port, std::span<const Sphere> ghost) {
    if (!ghost.empty()) {
        outline(list, port, outlineOf(port.view, ghost), colour::kPicked, 3.0f, true);
    }
}

} // namespace fathom::operate
