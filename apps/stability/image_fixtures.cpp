// SPDX-License-Identifier: Apache-2.0
#include "apps/stability/image_fixtures.h"

#include "engine/reference/classify.h"
#include "engine/reference/surface.h"
#include "engine/reference/thin.h"
#include "engine/types/colour_copy.h"

namespace fathom::stability {

namespace {

void add(const std::vector<reference::RegionSphere>& spheres, uint32_t firstSource, HostFixtures& set) {
    for (size_t i = 0; i < spheres.size(); ++i) {
        const reference::RegionSphere& s = spheres[i];
        if (s.radius < 0.0) {
            continue;
        }
        set.spheres.add(s.centre - set.origin, s.radius, firstSource + static_cast<uint32_t>(i),
                        static_cast<uint8_t>(s.cls));
    }
}

} // namespace

HostFixtures ImageFixtures::make(const Frame::Content& frame) {
    const Pose baseTcamera = frame.baseTcamera.value_or(scene_.baseTcamera);
    std::vector<uint32_t> rgba;
    readColours(frame, rgba);
    const reference::FrameView view(scene_, camera_, baseTcamera, frame.depth, rgba);
    std::optional<reference::CellBounds> cells;
    if (scene_.usesColour() && camera_.hasColour && !camera_.registered) {
        cells = reference::occlusion(view, 1e-3);
    }
    const auto classified = reference::classify(view, cells ? &cells->sure : nullptr);
    const auto surface = reference::surface(view, classified.masks);
    const std::vector<int> classes = reference::forbiddenClasses(scene_, classified.masks, surface.points);
    std::vector<double> growth;
    if (scene_.errorBudget > 0.0) {
        const auto thinned = reference::thin(scene_, view.width(), view.height(), classes, surface.points);
        growth = reference::keptGrowth(view.width(), view.height(), thinned);
    }
    HostFixtures set;
    set.origin = baseTcamera.position;
    set.camera = camera_;
    set.baseTcamera = baseTcamera;
    set.depth.assign(frame.depth.begin(), frame.depth.end());
    set.forbiddenBits.assign((classes.size() + 31) / 32, 0u);
    for (size_t i = 0; i < classes.size(); ++i) {
        set.forbiddenBits[i / 32] |=
            reference::forbiddenClass(scene_, classified.masks[i]) >= 0 ? 1u << (i % 32) : 0u;
    }
    add(reference::spheres(scene_, classes, surface.points, growth), 0, set);
    if (hold_) {
        const auto held = memory_.step(view, frame.captureTime, previousTime_, classes, surface.points);
        add(held, static_cast<uint32_t>(classes.size()), set);
        previousTime_ = frame.captureTime;
    }
    return set;
}

Scene redScene(double radius) {
    Scene scene;
    FixtureClass red;
    red.name = "red";
    red.hue = Band{345.0, 20.0};
    red.saturation = Band{0.4, 1.0};
    red.lightness = Band{0.05, 0.9};
    red.radius = radius;
    scene.fixtures.push_back(red);
    return scene;
}

} // namespace fathom::stability
