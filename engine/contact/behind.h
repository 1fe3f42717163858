// SPDX-License-Identifier: Apache-2.0
// Finds tool leaves that a new frame put on the far side of a surface. Overlap alone cannot tell; the depth
// image can.
#pragma once

#include "engine/contact/contact_set.h"

#include <cstdint>
#include <vector>

namespace fathom {

// Runs on the contact cadence, once per query, after the set is filled (allocates at first use only).
//
// A leaf is flagged when a NEW fixture set shows a forbidden surface in front of its centre, by more than
// 3 sigma of depth, and the centre was in front of a forbidden surface at the last query on the previous set.
// A leaf that gets behind a surface while the set stays the same, or was not seen in front of one before,
// came through free space or is hidden: it is occluded, not behind.
//
// The flag stays until the view to the leaf is free, or until it is clear in front: R + r before the surface,
// and no sphere overlaps it (noise puts some spheres before their pixel's depth). Where R + r is more than
// 6 sigma, a centre within 3 sigma BEFORE the surface counts as behind, too: only new data can have put it
// there. Normals point anywhere so close to the sphere centres and would squeeze the leaf or push it out
// behind.
class BehindTracker {
public:
    // regionRadius: largest radius of the set's spheres [m] (RegionGrid::maxRadius()). The set's pairs are
    // listed, or there are none. Fills set.behind.
    void update(const Tool& tool, const Fixtures& fixtures, double regionRadius, ContactSet& set);

private:
    // The frame at one point.
    struct DepthSample {
        bool known = false;     // inside the image, with a depth
        bool forbidden = false; // that pixel
        double before =
            0.0; // [m] along the optical axis that the point is nearer than the surface; < 0 = deeper
        double sigma = 0.0; // [m] of that depth
        double range = 0.0; // [m] from the camera to the surface on the point's own ray
    };
    static DepthSample sampleAt(const Fixtures& fixtures, const Pose& cameraTbase, const dvec3& point);

    struct Leaf {
        bool inFront = false;       // at the last query, of a forbidden surface
        bool inFrontBefore = false; // at the last query on the previous set
        bool behind = false;
        double range = 0.0; // [m] of the surface that it is behind
    };
    // A leaf at the query.
    struct LeafDistance {
        double resting = 0.0; // [m] before the surface where it may rest: R + r
        double range = 0.0;   // [m] from the camera to its centre
        double overlap = 0.0; // [m] deepest in any listed sphere; 0 = clear
    };
    static bool becameBehind(const DepthSample& sample, double resting);
    static void follow(Leaf& leaf, const DepthSample& sample, const LeafDistance& distance, bool newSet);

    std::vector<Leaf> leaves_;
    uint64_t generation_ = 0;
    bool any_ = false;
};

} // namespace fathom
