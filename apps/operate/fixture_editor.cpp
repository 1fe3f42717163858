// SPDX-License-Identifier: Apache-2.0
#include "apps/operate/fixture_editor.h"

#include "apps/session/session.h"
#include "engine/reference/classify.h"

#include <algorithm>
#include <cmath>

namespace fathom::operate {

namespace {

constexpr double kHueReach = 12.0;  // [degree] on each side of the picked hue
constexpr double kToneReach = 0.28; // half width of the saturation and lightness bands
constexpr uint32_t kPatch = 2;      // [pixels] average colour within this distance of the click
constexpr size_t kMaxHistory = 64;

// The colour of a depth pixel as the gates use it: without the water's attenuation.
uint32_t colourFor(const Scene& scene, const SceneSnapshot& snapshot, uint32_t u, uint32_t v, uint32_t rgba) {
    const CameraInfo& camera = snapshot.set.camera;
    const uint16_t raw = snapshot.set.depth[static_cast<size_t>(v) * camera.depth.width + u];
    if (!scene.attenuation || raw == 0) {
        return rgba;
    }
    const double range = raw * camera.metresPerUnit * glm::length(dvec3(camera.depth.ray(u, v), 1.0));
    return reference::withoutWater(rgba, *scene.attenuation, range).rgba;
}

bool selects(const FixtureClass& gates, uint32_t rgba) {
    const reference::Hsl hsl = reference::hslOf(rgba);
    return (!gates.hue || !hsl.grey) && inBand(gates.hue, hsl.hue) &&
           inBand(gates.saturation, hsl.saturation) && inBand(gates.lightness, hsl.lightness);
}

// Index into the colour image of a depth pixel; ignores parallax between two cameras.
size_t colourPixel(const CameraInfo& camera, uint32_t u, uint32_t v) {
    return static_cast<size_t>(v * camera.colour.height / camera.depth.height) * camera.colour.width +
           u * camera.colour.width / camera.depth.width;
}

std::string freeName(const Scene& scene, const std::string& stem) {
    for (int i = 1;; ++i) {
        const std::string name = stem + " " + std::to_string(i);
        if (std::none_of(scene.fixtures.begin(), scene.fixtures.end(),
                         [&](const auto& f) { return f.name == name; })) {
            return name;
        }
    }
}

// base_q_shape with its z along n.
dquat turnTo(const dvec3& n) {
    const dvec3 z = glm::normalize(n);
    const dvec3 x = glm::normalize(glm::cross(std::abs(z.x) < 0.9 ? dvec3(1, 0, 0) : dvec3(0, 1, 0), z));
    return glm::quat_cast(glm::dmat3(x, glm::cross(z, x), z));
}

} // namespace

bool inBand(const std::optional<Band>& band, double value) {
    return !band || (band->lo <= band->hi ? value >= band->lo && value <= band->hi
                                          : value >= band->lo || value <= band->hi);
}

FixtureEditor::FixtureEditor(const Scene& scene,
                             std::function<void(const Scene&, const std::vector<Shape>&)> onChange)
    : scene_(scene)
    , shapes_(shapesOf(scene))
    , onChange_(std::move(onChange))
    , saved_(rows()) {}

void FixtureEditor::pickAt(Console& console, const SceneSnapshot& snapshot, glm::uvec2 pixel) {
    const Intrinsics& lens = snapshot.set.camera.colour;
    if (snapshot.colour.size() != lens.pixels()) {
        return;
    }
    double x = 0.0, y = 0.0, saturation = 0.0, lightness = 0.0, count = 0.0;
    for (uint32_t v = pixel.y - std::min(pixel.y, kPatch); v <= std::min(lens.height - 1, pixel.y + kPatch);
         ++v) {
        for (uint32_t u = pixel.x - std::min(pixel.x, kPatch);
             u <= std::min(lens.width - 1, pixel.x + kPatch); ++u) {
            const CameraInfo& camera = snapshot.set.camera;
            const uint32_t rgba = colourFor(scene_, snapshot, u * camera.depth.width / lens.width,
                                            v * camera.depth.height / lens.height,
                                            snapshot.colour[static_cast<size_t>(v) * lens.width + u]);
            const reference::Hsl hsl = reference::hslOf(rgba);
            const double weight = hsl.grey ? 0.0 : hsl.saturation;
            x += weight * std::cos(glm::radians(hsl.hue));
            y += weight * std::sin(glm::radians(hsl.hue));
            saturation += hsl.saturation;
            lightness += hsl.lightness;
            count += 1.0;
        }
    }
    const auto around = [&](double value) {
        return Band{std::max(0.0, value / count - kToneReach), std::min(1.0, value / count + kToneReach)};
    };
    const double hue = std::fmod(glm::degrees(std::atan2(y, x)) + 360.0, 360.0);
    FixtureClass& gates = console.pick.gates;
    if (console.pick.row < 0) {
        gates = {};
        gates.name = freeName(scene_, "picked");
    }
    gates.hue = Band{std::fmod(hue - kHueReach + 360.0, 360.0), std::fmod(hue + kHueReach, 360.0)};
    gates.saturation = around(saturation);
    gates.saturation->lo = std::max(0.08, gates.saturation->lo); // the hue of grey pixels is undefined
    gates.saturation->hi = 1.0;
    gates.lightness = around(lightness);
    console.pick.taken = true;
    console.pick.u = pixel.x;
    console.pick.v = pixel.y;
    preview(console, snapshot);
}

void FixtureEditor::preview(Console& console, const SceneSnapshot& snapshot) {
    const CameraInfo& camera = snapshot.set.camera;
    ++selectionNumber_;
    selected_ = 0;
    hues_.fill(0.0f);
    if (!console.pick.taken || snapshot.colour.size() != camera.colour.pixels()) {
        selection_.clear();
        return;
    }
    selection_.assign(camera.depth.pixels(), 0);
    for (uint32_t v = 0; v < camera.depth.height; ++v) {
        for (uint32_t u = 0; u < camera.depth.width; ++u) {
            const size_t at = static_cast<size_t>(v) * camera.depth.width + u;
            const uint32_t rgba =
                colourFor(scene_, snapshot, u, v, snapshot.colour[colourPixel(camera, u, v)]);
            const reference::Hsl hsl = reference::hslOf(rgba);
            if (!hsl.grey && hsl.saturation > 0.08) {
                hues_[static_cast<size_t>(hsl.hue / 5.0) % hues_.size()] +=
                    static_cast<float>(hsl.saturation);
            }
            if (snapshot.set.depth[at] != 0 && selects(console.pick.gates, rgba)) {
                selection_[at] = 1;
                ++selected_;
            }
        }
    }
    const float most = *std::max_element(hues_.begin(), hues_.end());
    for (float& hue : hues_) {
        hue /= most > 0.0f ? most : 1.0f;
    }
}

bool FixtureEditor::takePicked(Console& console) {
    Scene next = scene_;
    const auto count = static_cast<int>(next.fixtures.size());
    const int row = console.pick.row;
    const auto spare = row >= 0 ? next.fixtures.begin() + std::min(row, count)
                                : std::find_if(next.fixtures.begin(), next.fixtures.end(), isSpare);
    if (row < 0) { // the name may be taken or empty by now
        const std::string wanted = console.pick.gates.name;
        const bool free = wanted.find_first_not_of(' ') != std::string::npos &&
                          std::none_of(next.fixtures.begin(), next.fixtures.end(),
                                       [&](const FixtureClass& f) { return f.name == wanted; });
        console.pick.gates.name = free ? wanted : freeName(next, "picked");
    }
    const bool added = console.pick.taken && spare != next.fixtures.end() &&
                       (row < 0 || spare->name == console.pick.gates.name); // undo may have moved rows
    if (added) {
        *spare = console.pick.gates;
        lastTaken_ = spare->name;
        apply(std::move(next));
    }
    console.pick = Pick{};
    selection_.clear();
    ++selectionNumber_;
    return added;
}

bool FixtureEditor::place(ShapeKind kind, const dvec3& base, const dvec3& normal) {
    if (shapes_.size() >= 16) {
        return false;
    }
    constexpr const char* kNames[] = {"", "sphere", "box", "plane", "cylinder", "line", "axis"};
    FixtureClass shape;
    shape.name = freeName(scene_, kNames[static_cast<int>(kind)]);
    shape.shape = kind;
    shape.role = kind == ShapeKind::Line || kind == ShapeKind::Axis ? Role::Guidance : Role::Forbidden;
    shape.baseTshape = {base, turnTo(normal)};
    shape.size = kind == ShapeKind::Box        ? dvec3(0.1)
                 : kind == ShapeKind::Cylinder ? dvec3(0.04, 0.1, 0)
                                               : dvec3(0.05, 0, 0);
    Scene next = scene_;
    next.fixtures.push_back(shape);
    apply(std::move(next));
    return true;
}

void FixtureEditor::change(size_t row, const FixtureClass& to) {
    Scene next = scene_;
    next.fixtures.at(row) = to;
    apply(std::move(next));
}

std::string FixtureEditor::rename(size_t row, const std::string& name) {
    FixtureClass renamed = scene_.fixtures.at(row);
    if (name == renamed.name) {
        return "";
    }
    const bool taken = std::any_of(scene_.fixtures.begin(), scene_.fixtures.end(),
                                   [&](const FixtureClass& f) { return f.name == name; });
    renamed.name = name;
    if (name.find_first_not_of(' ') == std::string::npos || isSpare(renamed)) {
        return "not renamed: a name needs a letter or digit";
    }
    if (taken) {
        return "not renamed: '" + name + "' exists already";
    }
    change(row, renamed);
    return "";
}

// The row of a class of points becomes a spare row; the row of a shape is erased.
void FixtureEditor::remove(size_t row) {
    Scene next = scene_;
    FixtureClass& f = next.fixtures.at(row);
    if (f.isPoints()) {
        FixtureClass spare = withSpareClasses(Scene{}).fixtures.front();
        spare.role = f.role;
        f = spare;
    } else {
        next.fixtures.erase(next.fixtures.begin() + static_cast<std::ptrdiff_t>(row));
    }
    apply(std::move(next));
}

void FixtureEditor::apply(Scene next) {
    past_.push_back(scene_.fixtures);
    if (past_.size() > kMaxHistory) {
        past_.erase(past_.begin());
    }
    future_.clear();
    scene_ = std::move(next);
    notifyChange();
}

void FixtureEditor::keep(const Scene::Window& window, const std::string& pilot) {
    scene_.window = window;
    scene_.choosePilot(pilot);
}

bool FixtureEditor::restore(std::vector<std::vector<FixtureClass>>& from,
                            std::vector<std::vector<FixtureClass>>& to) {
    if (from.empty()) {
        return false;
    }
    to.push_back(std::exchange(scene_.fixtures, std::move(from.back())));
    from.pop_back();
    notifyChange();
    return true;
}

bool FixtureEditor::undo() {
    return restore(past_, future_);
}

bool FixtureEditor::redo() {
    return restore(future_, past_);
}

void FixtureEditor::showFixtures(const Scene& scene) {
    scene_.fixtures = scene.fixtures;
    shapes_ = shapesOf(scene_);
    past_.clear();
    future_.clear();
    saved_ = rows();
}

void FixtureEditor::notifyChange() {
    shapes_ = shapesOf(scene_);
    onChange_(scene_, shapes_);
}

} // namespace fathom::operate
