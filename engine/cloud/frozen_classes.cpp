// SPDX-License-Identifier: Apache-2.0
#include "engine/cloud/frozen_classes.h"

#include <algorithm>

namespace fathom::cloud {

namespace {

void append(RegionSpheres& to, const RegionSpheres& from) {
    const size_t begin = to.size();
    to.resize(begin + from.size());
    for (size_t i = 0; i < from.size(); ++i) {
        to.replace(begin + i, from, i);
    }
}

void moveBy(RegionSpheres& spheres, size_t begin, const dvec3& by) {
    for (size_t i = begin; i < spheres.size(); ++i) {
        spheres.x[i] = static_cast<float>(spheres.x[i] + by.x);
        spheres.y[i] = static_cast<float>(spheres.y[i] + by.y);
        spheres.z[i] = static_cast<float>(spheres.z[i] + by.z);
    }
}

bool isFrozen(const Scene& scene, uint32_t row) {
    return row < scene.fixtures.size() && scene.fixtures[row].isPoints() && scene.fixtures[row].frozen;
}

} // namespace

FrozenClasses::FrozenClass FrozenClasses::take(const HostFixtures& set, uint32_t row) {
    FrozenClass kept{set.origin, {}, {}};
    const uint32_t moved = 2u * set.camera.depth.pixels();
    for (size_t i = 0; i < set.spheres.size(); ++i) {
        if (set.spheres.fixture[i] == row) {
            kept.spheres.addFrom(set.spheres, i);
            kept.spheres.source.back() += moved;
        }
    }
    const auto guidance = std::ranges::find(set.guidance, row, &GuidancePose::fixture);
    if (guidance != set.guidance.end()) {
        kept.guidance = *guidance;
    }
    return kept;
}

// After any change of classes_ or origin_.
void FrozenClasses::join() {
    auto all = std::make_shared<RegionSpheres>();
    for (const auto& [row, kept] : classes_) {
        const size_t begin = all->size();
        append(*all, kept.spheres);
        moveBy(*all, begin, kept.origin - origin_);
    }
    spheres_ = classes_.empty() ? nullptr : std::move(all);
    ++version_;
}

void FrozenClasses::placeOrigin(const dvec3& origin) {
    origin_ = origin;
    if (!classes_.empty()) {
        join();
    }
}

bool FrozenClasses::covers(const Scene& scene) {
    if (std::erase_if(classes_, [&](const auto& kept) { return !isFrozen(scene, kept.first); }) > 0) {
        join();
    }
    bool all = true;
    for (uint32_t row = 0; row < scene.fixtures.size(); ++row) {
        all = all && (!isFrozen(scene, row) || classes_.contains(row));
    }
    return all;
}

void FrozenClasses::apply(HostFixtures& set, const Scene& scene) {
    if (!covers(scene)) {
        for (uint32_t row = 0; row < scene.fixtures.size(); ++row) {
            if (isFrozen(scene, row) && !classes_.contains(row)) {
                classes_.emplace(row, take(set, row));
            }
        }
        join();
    }
    if (classes_.empty()) {
        return;
    }
    RegionSpheres& spheres = set.spheres;
    size_t live = 0;
    for (size_t i = 0; i < spheres.size(); ++i) {
        if (!classes_.contains(spheres.fixture[i])) {
            spheres.replace(live++, spheres, i);
        }
    }
    spheres.resize(live);
    append(spheres, *spheres_);
    for (GuidancePose& guidance : set.guidance) {
        const auto kept = classes_.find(guidance.fixture);
        guidance = kept != classes_.end() && kept->second.guidance ? *kept->second.guidance : guidance;
    }
}

} // namespace fathom::cloud
