// SPDX-License-Identifier: Apache-2.0
#include "apps/operate/view_click.h"

namespace fathom::operate {

void clickInView(Console& console, FixtureEditor& editor, const Screen& screen, const SceneSnapshot& scene,
                 ImVec2 at) {
    const auto pixel = screen.colourPixelAt(at);
    if (!pixel || console.spaceIsLarge) {
        if (console.aims()) {
            console.tell("in the camera view: Tab swaps");
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
    const uint32_t u = pixel->x * camera.depth.width / screen.large().view.lens.width;
    const uint32_t v = pixel->y * camera.depth.height / screen.large().view.lens.height;
    const uint16_t raw = scene.set.depth[static_cast<size_t>(v) * camera.depth.width + u];
    if (raw == 0) {
        console.tell("no depth there: click on a surface");
    } else {
        const double z = raw * camera.metresPerUnit;
        const glm::dvec2 ray = camera.depth.ray(u, v);
        const dvec3 base = scene.set.baseTcamera.apply(z * dvec3(ray, 1.0));
        const dvec3 towards = scene.set.baseTcamera.rotation * dvec3(0.0, 0.0, -1.0);
        console.tell(editor.place(console.placing, base, towards) ? "placed" : "no room: 16 shapes at most");
    }
    console.placing = ShapeKind::None;
}

} // namespace fathom::operate
