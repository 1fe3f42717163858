// SPDX-License-Identifier: Apache-2.0
// Comparisons of thinning, spheres and tree of the last frame with their float64 twins. Each twin gets the
// same input as its pass, so errors of one pass do not count in the next.
#pragma once

#include "apps/verify/pass_rig.h"

#include <cstdint>
#include <string>

namespace fathom::verify {

// wrong: decisions that differ although the twin is sure. unsure: those where float32 cannot decide.
struct ThinAgreement {
    uint64_t cells = 0, thinned = 0, wrong = 0, unsure = 0;
    uint64_t compared = 0; // growths of cells and quarters that both thin
    double growth = 0.0;   // [m] largest below the twin's, or more than a rounding step above it; may be NaN
};
ThinAgreement thinAgreement(const PassRig& rig);

struct SphereAgreement {
    uint64_t spheres = 0, wrong = 0;   // wrong: only one of both has a sphere, or another class
    uint64_t compared = 0;             // spheres that both have
    double centre = 0.0, radius = 0.0; // [m] largest errors; may be NaN
};
SphereAgreement sphereAgreement(const PassRig& rig);

// Each level's twin is made from the device's level below; the lowest from the spheres, held ones included.
struct TreeAgreement {
    uint64_t nodes = 0;   // bounds that both have, and nodes of the levels above, which the host counts
    uint64_t escaped = 0; // spheres outside their sub-patch's bound
    uint64_t wrong = 0;   // counts that differ, and bounds with a radius but no sphere
    double centre = 0.0,
           radius = 0.0; // [m] largest errors, of the radius against the twin's rounded outward;
                         // may be NaN
    std::string fault;   // reference::validateTree(); empty = valid
};
TreeAgreement treeAgreement(const PassRig& rig); // needs Plan::tree

} // namespace fathom::verify
