// SPDX-License-Identifier: Apache-2.0
#include "apps/operate/view_click.h"

#include <cmath>
#include <glm/geometric.hpp>

namespace fathom::operate {

namespace {

// Points of a depth image in the base frame.
class Cloud {
public:
    explicit Cloud(const Fixtures& set)
        : set_(set) {}

    std::optional<dvec3> at(int u, int v) const {
        const Intrinsics& lens = set_.camera.depth;
        if (u < 0 || v < 0 || u >= static_cast<int>(lens.width) || v >= static_cast<int>(lens.height)) {
            return std::nullopt;
        }
        const uint16_t raw = set_.depth[static_cast<size_t>(v) * lens.width + static_cast<size_t>(u)];
        if (raw == 0) {
            return std::nullopt;
        }
        const dvec3 ray(lens.ray(u, v), 1.0);
        return set_.baseTcamera.apply(raw * set_.camera.metresPerUnit * ray);
    }

    // Surface normal towards the camera, from neighbouring points; the direction to the camera without
    // neighbours.
    dvec3 normalAt(int u, int v) const {
        const dvec3 back = glm::normalize(set_.baseTcamera.position - at(u, v).value_or(dvec3(0.0)));
        for (const int reach : {4, 2, 1}) { // [pixels] larger is smoother
            const auto left = at(u - reach, v), right = at(u + reach, v), up = at(u, v - reach),
                       down = at(u, v + reach);
            if (left && right && up && down) {
                const dvec3 n = glm::cross(*down - *up, *right - *left);
                const double length = glm::length(n);
                // Steeper than 80 degrees is probably an edge between two surfaces.
                if (length > 0.0 && std::abs(glm::dot(n, back)) > 0.17 * length) {
                    return (glm::dot(n, back) > 0.0 ? n : -n) / length;
                }
            }
        }
        return back;
    }

private:
    const Fixtures& set_;
};

// A line or an axis needs two clicks, its start and its end; other shapes are placed on the surface.
void placeAt(Console& console, FixtureEditor& editor, const dvec3& base, const dvec3& normal) {
    constexpr double kShortest = 0.002; // [m]
    const bool twoClicks = console.placing == ShapeKind::Line || console.placing == ShapeKind::Axis;
    if (twoClicks && !console.placedFrom) {
        console.placedFrom = base;
        console.notify("now click on its end");
        return;
    }
    const dvec3 direction = twoClicks ? base - *console.placedFrom : normal;
    if (twoClicks && glm::length(direction) < kShortest) {
        console.notify("too short: click farther away");
        return;
    }
    const bool placed = editor.place(console.placing, twoClicks ? *console.placedFrom : base, direction);
    console.notify(placed ? "placed" : "not placed: at most 16 shapes");
    console.placing = ShapeKind::None;
    console.placedFrom.reset();
}

} // namespace

void clickInView(Console& console, FixtureEditor& editor, const Screen& screen, const SceneSnapshot& scene,
                 ImVec2 at) {
    const auto pixel = screen.colourPixelAt(at);
    if (!pixel || console.spaceIsLarge) {
        if (console.aims()) {
            console.notify("click in the camera view: Tab swaps the views");
        }
        return;
    }
    if (console.pick.active) {
        editor.pickAt(console, scene, *pixel);
        return;
    }
    if (console.placing == ShapeKind::None || scene.set.depth.empty()) {
        return;
    }
    const CameraInfo& camera = scene.set.camera;
    const auto u = static_cast<int>(pixel->x * camera.depth.width / screen.large().view.lens.width);
    const auto v = static_cast<int>(pixel->y * camera.depth.height / screen.large().view.lens.height);
    const Cloud cloud(scene.set);
    const auto base = cloud.at(u, v);
    if (!base) {
        console.notify("no depth there: click on a surface");
        return;
    }
    placeAt(console, editor, *base, cloud.normalAt(u, v));
}

} // namespace fathom::operate
