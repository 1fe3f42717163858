// SPDX-License-Identifier: Apache-2.0
// Picks a colour of the image: the gates around it, and the points that they select.
#include "apps/operate/fixture_editor.h"
#include "engine/cloud/frame_params.h"
#include "engine/reference/classify.h"

#include <algorithm>
#include <cmath>

namespace fathom::operate {

namespace {

constexpr double kHueReach = 12.0;  // [degree] on each side of the picked hue
constexpr double kToneReach = 0.28; // half width of the saturation and lightness bands
constexpr uint32_t kPatch = 2;      // [pixels] average colour within this distance of the click

// A camera without colour has neither pixels nor colours.
bool hasColours(const SceneSnapshot& snapshot) {
    return !snapshot.colour.empty() && snapshot.colour.size() == snapshot.set.camera.colour.pixels();
}

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

// Whether the point of a depth pixel is in the box and the range of a class.
bool inSpace(const FixtureClass& gates, const HostFixtures& set, uint32_t u, uint32_t v) {
    if (!gates.box && !gates.range) {
        return true;
    }
    const double z =
        set.depth[static_cast<size_t>(v) * set.camera.depth.width + u] * set.camera.metresPerUnit;
    const dvec3 point = z * dvec3(set.camera.depth.ray(u, v), 1.0), base = set.baseTcamera.apply(point);
    return inBand(gates.range, glm::length(point)) &&
           (!gates.box || (glm::all(glm::lessThanEqual(gates.box->min, base)) &&
                           glm::all(glm::lessThanEqual(base, gates.box->max))));
}

struct MeanColour {
    double hue = 0.0; // [degrees]
    double saturation = 0.0, lightness = 0.0;
};

// Of the pixels around one. Grey pixels have no part in the hue.
MeanColour meanAround(const Scene& scene, const SceneSnapshot& snapshot, glm::uvec2 pixel) {
    const CameraInfo& camera = snapshot.set.camera;
    const Intrinsics& lens = camera.colour;
    const glm::uvec2 last(std::min(lens.width - 1, pixel.x + kPatch),
                          std::min(lens.height - 1, pixel.y + kPatch));
    double x = 0.0, y = 0.0, saturation = 0.0, lightness = 0.0, count = 0.0;
    for (uint32_t v = pixel.y - std::min(pixel.y, kPatch); v <= last.y; ++v) {
        for (uint32_t u = pixel.x - std::min(pixel.x, kPatch); u <= last.x; ++u) {
            const uint32_t rgba = colourFor(scene, snapshot, u * camera.depth.width / lens.width,
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
    return {std::fmod(glm::degrees(std::atan2(y, x)) + 360.0, 360.0), saturation / count, lightness / count};
}

} // namespace

bool inBand(const std::optional<Band>& band, double value) {
    return !band || (band->lo <= band->hi ? value >= band->lo && value <= band->hi
                                          : value >= band->lo || value <= band->hi);
}

void FixtureEditor::pickAt(Console& console, const SceneSnapshot& snapshot, glm::uvec2 pixel) {
    if (!hasColours(snapshot)) {
        return;
    }
    const MeanColour mean = meanAround(scene_, snapshot, pixel);
    const auto around = [](double value) {
        return Band{std::max(0.0, value - kToneReach), std::min(1.0, value + kToneReach)};
    };
    FixtureClass& gates = console.pick.gates;
    if (console.pick.row < 0) {
        gates = {};
        gates.name = freeName("picked");
    }
    gates.hue = Band{std::fmod(mean.hue - kHueReach + 360.0, 360.0), std::fmod(mean.hue + kHueReach, 360.0)};
    gates.saturation = around(mean.saturation);
    gates.saturation->lo = std::max(0.08, gates.saturation->lo); // the hue of grey pixels is undefined
    gates.saturation->hi = 1.0;
    gates.lightness = around(mean.lightness);
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
    if (!console.pick.taken || !hasColours(snapshot)) {
        selection_.clear();
        return;
    }
    const bool anew = console.pick.row < 0; // a fixture that exists keeps its own box
    FixtureClass gates = console.pick.gates;
    gates.box = anew ? std::nullopt : gates.box;
    select(gates, snapshot);
    if (anew) {
        const glm::uvec2 clicked(console.pick.u * camera.depth.width / camera.colour.width,
                                 console.pick.v * camera.depth.height / camera.colour.height);
        console.pick.found =
            takeParts(selection_, snapshot.set, clicked, console.pick.rules, scene_.filter.edge);
        console.pick.gates.box = console.pick.found.box;
    }
    selected_ = static_cast<size_t>(std::count(selection_.begin(), selection_.end(), uint8_t{1}));
}

// The points that the gates accept, and the hues of the image.
void FixtureEditor::select(const FixtureClass& gates, const SceneSnapshot& snapshot) {
    const CameraInfo& camera = snapshot.set.camera;
    const auto [least, most] = cloud::depthBand(scene_, camera.metresPerUnit);
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
            const uint32_t raw = snapshot.set.depth[at];
            const bool seen = raw >= least && raw <= most && raw != 0;
            selection_[at] = seen && selects(gates, rgba) && inSpace(gates, snapshot.set, u, v) ? 1 : 0;
        }
    }
    const float greatest = *std::max_element(hues_.begin(), hues_.end());
    for (float& hue : hues_) {
        hue /= greatest > 0.0f ? greatest : 1.0f;
    }
}

} // namespace fathom::operate
