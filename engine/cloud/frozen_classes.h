// SPDX-License-Identifier: Apache-2.0
// Point classes whose spheres stay fixed in the base frame while new frames arrive.
#pragma once

#include "engine/contact/host_fixtures.h"
#include "engine/scene/scene.h"

#include <map>
#include <memory>
#include <optional>

namespace fathom::cloud {

// The GPU query has a copy of the fixed spheres of its own (TreeQuery). Frame thread only.
class FrozenClasses {
public:
    // The origin [m] of the next sets, base frame.
    void placeOrigin(const dvec3& origin);
    // Drops the classes that are no longer frozen. False when one has just been frozen: then apply() must
    // come first.
    bool covers(const Scene& scene);
    // Replaces spheres and targets of classes with FixtureClass::frozen in the host copy of a set by those of
    // the first set since the class was frozen. Other classes are unchanged. The fixed spheres come last.
    // Their sources are offset by twice the number of pixels, so that every source in a set is unique.
    void apply(HostFixtures& set, const Scene& scene);

    // The fixed spheres, about the origin, which no one changes; null = none. version(): changes with them; 0
    // = none so far.
    const std::shared_ptr<const RegionSpheres>& spheres() const { return spheres_; }
    uint64_t version() const { return version_; }

private:
    struct FrozenClass {
        dvec3 origin; // [m] of `spheres`, base frame: moved ones would be rounded
        RegionSpheres spheres;
        std::optional<GuidancePose> guidance;
    };
    static FrozenClass take(const HostFixtures& set, uint32_t row);
    void join();

    std::map<uint32_t, FrozenClass> classes_;      // by index into Scene::fixtures
    std::shared_ptr<const RegionSpheres> spheres_; // all of them, by row
    uint64_t version_ = 0;
    dvec3 origin_{0.0};
};

} // namespace fathom::cloud
