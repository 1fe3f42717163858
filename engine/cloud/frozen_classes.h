// SPDX-License-Identifier: Apache-2.0
// Point classes whose spheres stay fixed in the base frame while new frames arrive.
#pragma once

#include "engine/contact/fixtures.h"
#include "engine/scene/scene.h"

#include <map>
#include <optional>

namespace fathom::cloud {

// Changes the host copy of a set. The GPU query has a copy of the fixed spheres of its own (TreeQuery). Frame
// thread only.
class FrozenClasses {
public:
    // Replaces spheres and targets of classes with FixtureClass::frozen by those of the first set since the
    // class was frozen. Other classes are unchanged. Sources of frozen spheres are offset by twice the number
    // of pixels, so that every source in a set is unique. Returns the index of the first frozen sphere: they
    // are the last ones.
    size_t apply(Fixtures& set, const Scene& scene);
    uint64_t version() const { return version_; } // changes with the frozen spheres

private:
    struct Kept {
        dvec3 origin{0.0};
        RegionSpheres spheres;
        std::optional<GuidancePose> guidance;
    };
    static Kept take(const Fixtures& set, uint32_t row);

    std::map<uint32_t, Kept> kept_; // by row of Scene::fixtures
    uint64_t version_ = 0;
};

} // namespace fathom::cloud
