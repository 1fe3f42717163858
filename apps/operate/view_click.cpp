// SPDX-License-Identifier: Apache-2.0
#include "apps/operate/view_click.h"

#include <cmath>
#include <glm/geometric.hpp>

namespace fathom::operate {

namespace {

// Points of a depth image in the base frame.
class Cloud {
public:
    explicit Cloud(const HostFixtures& set)
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
    const HostFixtures& set_;
};

struct SurfacePoint {
    dvec3 base, normal;
};

// The surface under a point of the window.
std::optional<SurfacePoint> surfaceUnder(const Screen& screen, const HostFixtures& set, ImVec2 at) {
    const auto pixel = screen.colourPixelAt(at);
    if (!pixel || set.depth.empty()) {
        return std::nullopt;
    }
    const auto u = static_cast<int>(pixel->x * set.camera.depth.width / screen.large().view.lens.width);
    const auto v = static_cast<int>(pixel->y * set.camera.depth.height / screen.large().view.lens.height);
    const Cloud cloud(set);
    const auto base = cloud.at(u, v);
    return base ? std::optional(SurfacePoint{*base, cloud.normalAt(u, v)}) : std::nullopt;
}

// A line or an axis needs two clicks, its start and its end; other shapes are placed on the surface. Empty
// while the start is missing, or the end is too close to it.
std::optional<FixtureClass> shapeFrom(const Console& console, const FixtureEditor& editor,
                                      const SurfacePoint& at) {
    constexpr double kShortest = 0.002; // [m]
    if (console.placing.shape != ShapeKind::Line && console.placing.shape != ShapeKind::Axis) {
        return editor.shapeAt(console.placing.shape, at.base, at.normal);
    }
    if (!console.placing.from || glm::distance(at.base, *console.placing.from) < kShortest) {
        return std::nullopt;
    }
    return editor.shapeAt(console.placing.shape, *console.placing.from, at.base - *console.placing.from);
}

void placeAt(Console& console, FixtureEditor& editor, const SurfacePoint& at) {
    const std::optional<FixtureClass> shape = shapeFrom(console, editor, at);
    if (!shape) {
        console.notify(console.placing.from ? "too short: click farther away" : "now click on its end");
        console.placing.from = console.placing.from.value_or(at.base);
        return;
    }
    const std::string problem = editor.place(*shape);
    console.notify(problem.empty() ? "placed" : problem);
    console.placing = {};
}

} // namespace

void clickInView(Console& console, FixtureEditor& editor, const Screen& screen, const SceneSnapshot& scene,
                 ImVec2 at) {
    const auto pixel = screen.colourPixelAt(at);
    if (!pixel || console.settings.spaceIsLarge) {
        if (console.aims()) {
            console.notify("click in the camera view: Tab swaps the views");
        }
        return;
    }
    if (console.pick.active) {
        editor.pickAt(console, scene, *pixel);
        return;
    }
    if (console.placing.shape == ShapeKind::None || scene.set.depth.empty()) {
        return;
    }
    const auto surface = surfaceUnder(screen, scene.set, at);
    if (!surface) {
        console.notify("no depth there: click on a surface");
        return;
    }
    placeAt(console, editor, *surface);
}

std::optional<Shape> shapeToPlace(const Console& console, const FixtureEditor& editor, const Screen& screen,
                                  const HostFixtures& set) {
    const ImGuiIO& io = ImGui::GetIO();
    if (console.placing.shape == ShapeKind::None || console.settings.spaceIsLarge ||
        (!console.cursor && io.WantCaptureMouse)) {
        return std::nullopt;
    }
    const auto surface = surfaceUnder(screen, set, console.cursor.value_or(io.MousePos));
    const auto fixture = surface ? shapeFrom(console, editor, *surface) : std::nullopt;
    return fixture ? std::optional(Shape{fixture->shape, false, fixture->size, fixture->baseTshape, 0})
                   : std::nullopt;
}

} // namespace fathom::operate
