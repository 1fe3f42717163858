// SPDX-License-Identifier: Apache-2.0
#include "apps/replay/overlay_image.h"
#include "apps/replay/overlay_layers.h"

#include <doctest/doctest.h>

using namespace fathom;

TEST_CASE("The legend of an overlay names only what is inside the image") {
    OverlayInput input;
    input.camera.depth.width = 160, input.camera.depth.height = 120;
    input.camera.depth.fx = input.camera.depth.fy = 150.0;
    input.camera.depth.cx = 79.5, input.camera.depth.cy = 59.5;
    const ImageView view = imageView(input.camera, {}, true, 160);
    const std::vector<Sphere> leaves{{{0.0, 0.0, 0.0}, 0.01}};
    input.leaves = leaves;
    input.tick.tool.position = input.tick.device.position = {0.0, 0.0, 0.5};
    HostFixtures set;
    set.frame = 0;
    set.camera = input.camera;
    set.spheres.resize(1);
    set.spheres.x = {2.0f}, set.spheres.y = {0.0f}, set.spheres.z = {0.6f}; // outside of the image
    set.spheres.radius = {0.04f};
    set.guidance.resize(1);
    set.guidance[0].present = true;
    set.guidance[0].position = {0.0, -2.0, 0.6};
    input.set = &set;
    overlay::SeenLayers seen = overlay::seenLayers(view, input);
    CHECK(seen.tool);
    CHECK(!seen.hand); // where the tool is
    CHECK(!seen.regions);
    CHECK(!seen.points);
    CHECK(!seen.guidance);
    CHECK(!seen.force);
    input.tick.device.position = {0.05, 0.0, 0.5};
    input.tick.wrench.force = {1.0, 0.0, 0.0};
    set.spheres.x = {0.18f}; // the region is half inside
    set.guidance[0].position = {0.0, 0.1, 0.6};
    seen = overlay::seenLayers(view, input);
    CHECK(seen.hand);
    CHECK(seen.force);
    CHECK(seen.regions);
    CHECK(seen.points);
    CHECK(seen.guidance);
    set.spheres.source = {160 * 120}; // held
    seen = overlay::seenLayers(view, input);
    CHECK(seen.held);
    CHECK(!seen.regions);
    input.tick.tool.position.x = 3.0;
    CHECK(!overlay::seenLayers(view, input).tool);
}

TEST_CASE("An overlay of a narrow image is not enlarged beyond 4096 rows, and can be drawn") {
    struct Case {
        uint32_t width, height;
        int scale;
    };
    for (const Case& c : {Case{1, 300, 13}, Case{10, 400, 10}, Case{2, 2160, 1}, Case{240, 1024, 4}}) {
        CAPTURE(c.width);
        OverlayInput input;
        input.camera.depth.width = c.width, input.camera.depth.height = c.height;
        input.camera.depth.fx = input.camera.depth.fy = 150.0;
        const int width = static_cast<int>(c.width), height = static_cast<int>(c.height);
        const fathom::Image image = drawOverlay(input);
        CHECK(image.width() == width * c.scale);
        CHECK(image.height() == height * c.scale + 88); // and the caption
    }
}
