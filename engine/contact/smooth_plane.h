// SPDX-License-Identifier: Apache-2.0
// The plane that a leaf slides on where many region spheres form a surface. The spheres' union has cusps
// between neighbours; a tool that slides over them feels a sawtooth of slope spacing / 2 (R + r). The plane
// has the mean normal of the nearest spheres of one surface and lies outside of all of them.
#pragma once

#include "engine/contact/pair_gaps.h"

namespace fathom {

struct SmoothPlane {
    dvec3 normal{0.0}; // unit, out of the region
    double gap = 0.0;  // [m] from the leaf; at most the nearest pair's gap
};

// Half width L of the patch of surface that one plane represents, in units of R + r: 10 degrees of the
// sphere.
inline constexpr double kPatch = 0.18;
// The plane curves like a sphere of radius (R + r) / kBend, so that the patch's border is never felt.
inline constexpr double kBend = 0.01;

// Cosines of the angles from the nearest sphere's normal between which a sphere belongs to another surface
// and does not count, as at the other wall of a corner. Within 36 degrees spheres of similar size count in
// full. Opposite ones, beyond 120 degrees, do so too: planes must not hold a leaf from both sides of a slot.
inline constexpr double kOtherSurface = 0.70710678118654752,
                        kOpposite = -0.4; // beyond this one they count again

// Plane for a leaf over the surface whose nearest sphere has this tangent, at a gap >= 0. run: pairs of the
// leaf, complete up to that gap + depth. False where a sphere that counts is nearer, and where
// there is no plane outside of the nearest sphere, as at an edge; the spheres' own rows then suffice.
// Identical bits everywhere.
bool smoothPlane(const SphereSpan& run, const Sphere& leaf, const SmoothPlane& nearest, double depth,
                 SmoothPlane& plane) noexcept;

// [m] how much farther than the nearest the spheres of a patch may be; reach = R + r of the nearest.
constexpr double patchDepth(double reach) noexcept {
    return 0.5 * kPatch * kPatch * reach;
}

} // namespace fathom
