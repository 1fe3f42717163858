// SPDX-License-Identifier: Apache-2.0
// Finds tool leaves that a new frame put on the far side of a surface. The overlap does not show the side;
// the depth image does.
#pragma once

#include "engine/contact/contact_set.h"

#include <cstdint>
#include <span>
#include <vector>

namespace fathom {

// Pixels with a forbidden class as the passes leave them, before the host has its copy
// (HostFixtures::forbiddenBits). Both give the same answers.
struct PatchBits {
    std::span<const uint32_t> listed; // per patch of 16x16 pixels; 0 = no such pixel, whatever its bits are
    std::span<const uint32_t> bits;   // per sub-patch of 4x4 pixels, 16 per patch: one bit per pixel
    uint32_t across = 0;              // patches

    bool at(uint32_t u, uint32_t v) const {
        const uint32_t patch = v / 16 * across + u / 16, sub = v % 16 / 4 * 4 + u % 16 / 4;
        return listed[patch] != 0 && (bits[patch * 16 + sub] >> (v % 4 * 4 + u % 4) & 1u) != 0;
    }
};

// Runs at contact cadence, once per query, after the set is filled. Allocates at first use only.
//
// A leaf is flagged when a NEW fixture set shows a forbidden surface in front of its centre, by more than
// 3 sigma of depth, and the centre was in front of a forbidden surface at the last query on the previous
// set. A leaf that gets behind a surface while the set is unchanged, or that was not in front of one
// before, moved through free space or is hidden. It is occluded, not behind. So is a leaf behind something
// that appears far in front of it. The surface that a leaf was in front of is taken to come nearer by at most
// R + r and 100 mm between two sets (3 m/s at 30 Hz), and to cover more than a pixel. Nearer to the leaf than
// R + r and the query's reach, any surface counts if the set has a sphere there, which it has not where the
// filter rejected the point.
//
// The flag stays until the view to the leaf is free, or until the leaf is clear in front: R + r before the
// surface and not overlapping any sphere (noise puts some spheres before their pixel's depth). Where R + r is
// more than 6 sigma, a centre within 3 sigma BEFORE the surface also counts as behind, because only new data
// can have put it there. So close to the sphere centres normals are arbitrary and would squeeze the leaf or
// push it out behind.
class BehindTracker {
public:
    // regionRadius: largest radius of the set's spheres [m] (RegionGrid::maxRadius()). The pairs of the set
    // must be listed already. Fills set.behind. Reads no spheres of the fixtures, and with
    // `bits` no forbiddenBits, so that their host copy may still be incomplete.
    void update(const Tool& tool, const HostFixtures& fixtures, double regionRadius, ContactSet& set,
                const PatchBits* bits = nullptr);

private:
    // The depth frame sampled at one point.
    struct DepthSample {
        bool known = false;     // inside the image, with a depth
        bool forbidden = false; // the pixel has a forbidden class
        // [m] distance of the point before the surface along the optical axis; < 0 = deeper
        double before = 0.0;
        double z = 0.0;   // [m] of the pixel
        dvec3 point{0.0}; // [m] camera frame
        // [m] three standard deviations of the depth there
        double margin(const CameraInfo& camera) const;
        // [m] from the camera to the surface on the point's own ray
        double range() const { return glm::length(point) * z / point.z; }
    };
    static DepthSample sampleAt(const HostFixtures& fixtures, const PatchBits* bits, const Pose& cameraTbase,
                                const dvec3& point);

    struct Leaf {
        bool inFront = false; // in front of a forbidden surface at the last query
        bool behind = false;
        // [m] from the camera to the surface that it is behind; else depth of the surface on its pixel
        double range = 0.0;
    };
    // A leaf at the query.
    struct LeafPlace {
        dvec3 toCamera{0.0};
        double range = 0.0;   // [m] from the camera to its centre
        double resting = 0.0; // [m] distance before the surface at rest: R + r
        double nearer = 0.0;  // [m] the surface comes nearer to the camera by at most this, in one frame
        double overlap = 0.0; // [m] deepest overlap with a listed sphere; 0 = clear
    };
    static LeafPlace placeOf(const ContactSet& set, uint32_t leaf, double radius, double regionRadius);
    static bool becameBehind(const HostFixtures& fixtures, const DepthSample& sample, const LeafPlace& place,
                             const Leaf& leaf, uint32_t index, const ContactSet& set);
    static void follow(const HostFixtures& fixtures, const DepthSample& sample, const LeafPlace& place,
                       Leaf& leaf);

    std::vector<Leaf> leaves_;
    uint64_t generation_ = 0;
    bool any_ = false;
};

} // namespace fathom
