// SPDX-License-Identifier: Apache-2.0
// Classes of points that stay where they were while the frame goes on.
#pragma once

#include "engine/contact/fixtures.h"
#include "engine/scene/scene.h"

#include <map>
#include <optional>

namespace fathom::cloud {

// On the host's copy of a set, so for contact queries of the CPU only. Frame cadence.
class FrozenClasses {
public:
    // Spheres and targets of FixtureClass::frozen become those of the first set that was given here since
    // they are; other classes are left alone. Sources of frozen spheres are moved by twice the pixels, so
    // that no two spheres of a set share one.
    void apply(Fixtures& set, const Scene& scene);

private:
    struct Kept {
        dvec3 origin{0.0};
        RegionSpheres spheres;
        std::optional<GuidancePose> guidance;
    };
    static Kept take(const Fixtures& set, uint32_t row);

    std::map<uint32_t, Kept> kept_; // by row of Scene::fixtures
};

} // namespace fathom::cloud
