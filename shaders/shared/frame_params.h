// SPDX-License-Identifier: Apache-2.0
// Parameters of a frame: sizes, lenses, poses, gates. The CPU writes them once per frame.
#ifndef FATHOM_SHARED_FRAME_PARAMS_H
#define FATHOM_SHARED_FRAME_PARAMS_H
#include "shaders/shared/interop.h"
FATHOM_SHARED_BEGIN

FATHOM_CONST kMaxClasses = 8; // classes of points in a scene: bits of a pixel's mask

// One class of points. Gates are inclusive; unused gates have bounds that nothing exceeds.
struct ClassParams {
    vec4 hue;      // lo, hi [degree]; 1 = wraps through 0; 0 = grey passes, -1 = it does not
    vec4 satLight; // saturation lo, hi; lightness lo, hi [1/510]
    vec4 boxMin;   // base axes about the origin [m]; w = 1: has a box
    vec4 boxMax;   // w = 0: points whose colour is not seen pass, -1: they do not
    vec4 role;     // region radius with 3 registration sigma [m]; 1 = forbidden; 1 = guidance; row of
                   // Scene::fixtures
};
FATHOM_SIZE(ClassParams, 80);

struct FrameParams {
    uvec4 size;       // depth width, height; patches across, down
    uvec4 colourSize; // colour width, height; occlusion cells across, edge of a cell [pixels]
    uvec4 depthBand;  // smallest and largest valid raw depth (near, far); classes; classes that are forbidden
                      // (bits)
    uvec4 time;      // capture time now [us, wraps]; hold [us]; capture time of the last frame [us]; order of
                     // forbidden classes (4 bits each)
    vec4 lens;       // depth fx, fy, cx, cy [pixels]
    vec4 distortion; // depth k1, k2, p1, p2
    vec4 colourLens; // fx, fy, cx, cy
    vec4 colourDistortion; // k1, k2, p1, p2
    vec4 more;             // depth k3, colour k3, metres per raw unit, depth jump that is an edge (relative)
    vec4 filterParams;     // 1 / (2 sigma^2) [1/m^2], error budget [m], isolation distance [m], 3 x isolation
                           // pixels / focal
    vec4 noise;            // depth sigma = x + y z^2 [m]; 3 = how many sigma count as different; -
    vec4 baseTcamera[3];   // rows of [R | t], t about the origin [m]
    vec4 cameraTbase[3];
    vec4 colourTdepth[3];
    ClassParams classes[8];
    vec4 beam;      // sigma along a beam = x + y r [m], across it z r [m] (BeamSigma); -
    vec4 ranges[8]; // per class: least and largest range [m]; 1 = has a range gate; -
    vec4 water;     // red, green, blue of stored bytes: logarithm of what a metre takes of them [1/m]; -
    vec4 steps; // of a ray from pixel to pixel: 1 / depth fx, 1 / depth fy; of what a sphere grows by [m]; 1
                // / that
};
FATHOM_SIZE(FrameParams, 64 + 112 + 144 + 640 + 176);

// Steps of growth that the whole error budget has: what a packed sphere grows by takes 8 bits.
FATHOM_CONST kGrowthSteps = 255;
// Of a packed run (packing.glsl): of its seen spheres some have grown; their depths differ by more than 24
// bits.
FATHOM_CONST kRunGrown = 0x80000000;
FATHOM_CONST kRunWide = 0x40000000;

// State of a patch, bits of a word.
FATHOM_CONST kPatchListed = 1;  // it has work
FATHOM_CONST kPatchGuided = 2;  // a pixel of it is in a guidance class
FATHOM_CONST kPatchHolding = 4; // listed, and its memory holds points; where classify makes the lists

// Zero when a frame begins: the pass `deliver` clears them. Integers only: their sums do not depend on the
// order. The list of patches has three parts, each with room for all patches: listed patches; guided patches;
// listed patches that hold no points, and backwards from the end those that hold some.
FATHOM_CONST kArgumentWords = 20; // its first: x, y, z groups of five indirect dispatches, and a count each
struct FrameCounters {
    uvec4 patchGroups;   // indirect arguments: one group a listed patch (x = listed patches, 1, 1)
    uvec4 subGroups;     // indirect arguments: one invocation per sub-patch of a listed patch
    uvec4 guidedGroups;  // as patchGroups where classify makes the lists, else as subGroups; w = guided ones
    uvec4 quietGroups;   // as subGroups, of listed patches that hold nothing; w = how many these are
    uvec4 holdingGroups; // the same of those that hold
    uint nodes;          // used nodes of the tree
    uint packedWords;    // of all runs (packing.glsl)
    uint pad[2];
    uint classPixels[8]; // marked pixels per class
    uint leakSpacing[8]; // bits of the largest spacing between neighbours that is >= R, a class; 0 = none
    uint leakRange[8];   // bits of the largest range [m] where that happens, a class
};
FATHOM_SIZE(FrameCounters, 192);

// Moments of one guidance class in one patch, about the patch mean. The mean is anchor + offset: as one
// float32 it would lose digits that the covariance of a small class needs.
struct PatchMoments {
    vec4 anchor; // a point of the class, base axes about the origin [m]; w = count
    vec4 offset; // mean - anchor [m]
    vec4 first;  // sums of xx, xy, xz, yy [m^2]
    vec4 second; // sums of yz, zz; -, -
};
FATHOM_SIZE(PatchMoments, 64);

// Levels of the region tree: 0 = 4x4 pixels (patch-major), 1 = patches, then 4x4 of the level below up to one
// root.
FATHOM_CONST kMaxLevels = 6;
struct TreeParams {
    uvec4 levels[6]; // nodes across, down; index of the first node; -
    uvec4 run;       // first level and last level of this dispatch; number of levels; -
};
FATHOM_SIZE(TreeParams, 112);

FATHOM_SHARED_END
#endif
