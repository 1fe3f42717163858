// SPDX-License-Identifier: Apache-2.0
// Sections `pilots` and `window` of a scene file.
#include "engine/scene/load.h"

#include <algorithm>

namespace fathom {

namespace {

constexpr size_t kMaxPilots = 32;

Scene::Pilot loadPilot(const YamlNode& row, const Scene& scene) {
    row.checkKeys({"name", "stiffness", "rotational_stiffness", "limits", "guidance_pull", "friction",
                   "damping", "margin", "smooth", "scale"});
    Scene::Pilot pilot{row.at("name").text(), scene.haptics, scene.hand.scale};
    const auto sameName = [&](const Scene::Pilot& other) { return other.name == pilot.name; };
    if (std::any_of(scene.pilots.begin(), scene.pilots.end(), sameName)) {
        row.at("name").refuse("a name not used by an earlier pilot");
    }
    loadFeel(row, pilot.haptics);
    row.read("scale", pilot.scale, Range::between(1e-3, 100.0));
    return pilot;
}

} // namespace

void loadPilots(const YamlNode& pilots, Scene& scene) {
    const std::vector<YamlNode> rows = pilots.list();
    if (rows.empty() || rows.size() > kMaxPilots) {
        pilots.refuse(std::to_string(rows.size()) + " pilots", "1 to " + std::to_string(kMaxPilots));
    }
    for (const YamlNode& row : rows) {
        scene.pilots.push_back(loadPilot(row, scene));
    }
    scene.choosePilot(scene.pilots.front().name);
}

void loadWindow(const YamlNode& window, Scene& scene) {
    window.checkKeys({"text_scale", "large", "yaw", "pitch", "distance", "layout", "tones"});
    scene.window = Scene::Window{};
    Scene::Window& w = *scene.window;
    window.read("text_scale", w.textScale, Range::between(0.75, 2.5));
    window.read("large", w.spaceIsLarge, {{"camera", false}, {"space", true}});
    window.read("layout", w.pilotLayout, {{"engineer", false}, {"pilot", true}});
    window.read("tones", w.tones);
    window.read("yaw", w.yaw, Range::between(-1e3, 1e3));
    window.read("pitch", w.pitch, Range::between(-1.571, 1.571));
    window.read("distance", w.distance, Range::between(0.15, 8.0));
}

} // namespace fathom
