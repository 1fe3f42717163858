// SPDX-License-Identifier: Apache-2.0
#include "apps/replay/overlay_layers.h"

#include <algorithm>

namespace fathom::overlay {

namespace {

bool isInside(const ImageView& view, const std::optional<glm::dvec2>& p) {
    return p && p->x >= 0.0 && p->y >= 0.0 && p->x < view.width() && p->y < view.height();
}

bool seesLeaves(const ImageView& view, std::span<const Sphere> leaves, const Pose& pose) {
    if (!isFinite(pose)) {
        return false;
    }
    Silhouette silhouette(view);
    for (const Sphere& leaf : leaves) {
        silhouette.add(pose.apply(leaf.centre), leaf.radius);
    }
    return silhouette.covered().width() > 0;
}

// Whether the two poses of the tool look different in the image.
bool differ(const ImageView& view, std::span<const Sphere> leaves, const Pose& a, const Pose& b) {
    constexpr double kApart = 2.0; // [pixels]
    return std::any_of(leaves.begin(), leaves.end(), [&](const Sphere& leaf) {
        const auto p = view.ofBase(a.apply(leaf.centre)), q = view.ofBase(b.apply(leaf.centre));
        return p.has_value() != q.has_value() || (p && glm::distance(*p, *q) > kApart);
    });
}

} // namespace

SeenLayers seenLayers(const ImageView& view, const OverlayInput& input) {
    SeenLayers seen;
    if (input.set != nullptr && input.set->frame >= 0) {
        const HostFixtures& set = *input.set;
        const RegionMasks masks = regionMasks(view, set);
        constexpr std::ptrdiff_t kMinHeld = 100; // [pixels]
        seen.held = std::count(masks.held.begin(), masks.held.end(), 1) >= kMinHeld;
        seen.regions = std::find(masks.seen.begin(), masks.seen.end(), 1) != masks.seen.end();
        for (size_t i = 0; i < set.spheres.size() && !seen.points; ++i) {
            seen.points = isInside(view, view.ofBase(regionCentre(set, i)));
        }
        for (const GuidancePose& g : set.guidance) {
            seen.guidance = seen.guidance || (g.present && isInside(view, view.ofBase(g.position)));
        }
    }
    const StepRecord& tick = input.tick;
    seen.tool = seesLeaves(view, input.leaves, tick.tool);
    seen.hand = seesLeaves(view, input.leaves, tick.device) &&
                (!isFinite(tick.tool) || differ(view, input.leaves, tick.tool, tick.device));
    seen.force = isFinite(tick.wrench.force) && glm::length(tick.wrench.force) >= kMinArrow &&
                 isFinite(tick.tool) && isInside(view, view.ofBase(tick.tool.position));
    return seen;
}

} // namespace fathom::overlay
