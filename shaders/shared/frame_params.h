// SPDX-License-Identifier: Apache-2.0
// Parameters of a frame: sizes, lenses, poses, gates. The CPU writes them once per frame.
#ifndef FATHOM_SHARED_FRAME_PARAMS_H
#define FATHOM_SHARED_FRAME_PARAMS_H
#include "shaders/shared/interop.h"
FATHOM_SHARED_BEGIN

FATHOM_CONST kMaxClasses = 8; // point classes per scene: bits of a pixel's mask

// One point class. Gates are inclusive; an unused gate has bounds that every point passes.
struct ClassParams {
    vec4 hue;      // lo, hi [degree]; 1 = wraps through 0; w = 0: grey passes, -1: it fails
    vec4 satLight; // saturation lo, hi; lightness lo, hi [1/510]
    vec4 boxMin;   // base axes, relative to the origin [m]; w = 1: has a box
    vec4 boxMax;   // w = 0: points without a visible colour pass, -1: they fail
    vec4 role;     // region radius incl. 3 sigma of the registration [m]; 1 = forbidden; 1 = guidance; row of
                   // Scene::fixtures
};
FATHOM_SIZE(ClassParams, 80);

struct FrameParams {
    uvec4 size;       // depth width, height; patches across, down
    uvec4 colourSize; // colour width, height; occlusion cells across, edge of a cell [pixels]
    uvec4 depthBand;  // smallest and largest valid raw depth; number of classes; bits of forbidden classes
    uvec4 time; // capture time [us, wraps]; hold time [us]; capture time of the previous frame [us]; order of
                // forbidden classes (4 bits each)
    vec4 lens;  // depth fx, fy, cx, cy [pixels]
    vec4 distortion;       // depth k1, k2, p1, p2
    vec4 colourLens;       // fx, fy, cx, cy
    vec4 colourDistortion; // k1, k2, p1, p2
    vec4 depthAndEdges;    // depth k3, colour k3, metres per raw unit, depth jump that is an edge (relative)
    vec4 filterParams;     // 1 / (2 sigma^2) [1/m^2], error budget [m], isolation distance [m], 3 x isolation
                           // pixels / focal
    vec4 noise;            // depth sigma = x + y z^2 [m]; z: number of sigma (3) that counts as a difference;
                           // w: most that the filter moves a point [m]
    vec4 baseTcamera[3];   // rows of [R | t], t relative to the origin [m]
    vec4 cameraTbase[3];
    vec4 colourTdepth[3];
    ClassParams classes[kMaxClasses];
    vec4 beam;                // sigma along a beam = x + y r [m], across it z r [m] (BeamSigma); -
    vec4 ranges[kMaxClasses]; // per class: least and largest range [m]; 1 = has a range gate; -
    vec4 water;               // attenuation of stored red, green, blue [1/m]; -
    vec4 lensDivisor;         // depth k4, k5, k6; square of Intrinsics::reach()
    vec4 colourLensDivisor;   // the same of colour
    vec4 steps;       // ray increments per pixel 1 / fx, 1 / fy; growth step of spheres [m]; its reciprocal
    uvec4 memory;     // number of this frame and of the frame that the estimates come from (0 = none); most
                      // frames that an estimate averages, and that it outlasts its pixel
    vec4 memoryGates; // largest jump and drift of an estimate: in sigma, x and z, but at most y and w [m]
    // Change that is not shown: in sigma, x, but at most y [m]; z: variance of a moved pose [m^2]; w: 1 = the
    // camera has moved since the frame that the estimates come from.
    vec4 memoryLimits;
    vec4 previousTbase[3]; // rows of the pose of that frame, as cameraTbase
    uvec4 planes; // colour in planes, ColourPlanes: step of luma rows, first U, first V, step of chroma rows
                  // [bytes]
    uvec4 chroma; // log2 of the columns and rows that share a sample, and of the bytes between samples;
                  // classes that test colour while the colour image is dark
};
FATHOM_SIZE(FrameParams, 64 + 112 + 144 + 640 + 208 + 128);

// Numbers of frames in the memory of estimates wrap here.
FATHOM_CONST kMemoryFrames = 0x1000000;

// Growth steps in the error budget: a packed sphere stores its growth in 8 bits.
FATHOM_CONST kGrowthSteps = 255;
// Flags of a packed run (packing.glsl): some seen spheres have grown; their depths need more than 24 bits.
FATHOM_CONST kRunGrown = 0x80000000;
FATHOM_CONST kRunWide = 0x40000000;

// State of a patch, bits of a word.
FATHOM_CONST kPatchListed = 1; // it is listed: it has work
FATHOM_CONST kPatchGuided = 2; // it has a pixel of a guidance class
FATHOM_CONST kPatchHolding =
    4; // listed, and its memory holds points; set only where `classify` makes the lists

// Counters of one frame. `deliver` clears them for the next one. Integers only, so sums do not depend on the
// order. The patch list has three parts, each with room for all patches: listed patches; guided patches; and
// listed patches without held points, followed from the end backwards by those with held points.
FATHOM_CONST kArgumentWords =
    20; // words at the start: for five indirect dispatches the groups x, y, z and a count
struct FrameCounters {
    uvec4 patchGroups;    // indirect arguments: one group per listed patch (x = listed patches, 1, 1)
    uvec4 subPatchGroups; // indirect arguments: one invocation per sub-patch of a listed patch
    uvec4 guidedGroups; // as patchGroups where `classify` makes the lists, else as subPatchGroups; w = guided
                        // patches
    uvec4 withoutHeldGroups; // as subPatchGroups, for listed patches without held points; w = their number
    uvec4 withHeldGroups;    // the same for listed patches with held points
    uint subs;               // 4x4 sub-patches with a sphere
    uint packedWords;        // words in all runs (packing.glsl)
    uint pad[2];
    uint classPixels[kMaxClasses]; // marked pixels per class
    uint leakSpacing[kMaxClasses]; // per class: float bits of the largest spacing [m] between neighbours that
                                   // is >= R; 0 = none
    uint leakRange[kMaxClasses];   // per class: float bits of the largest range [m] of such neighbours
    uint largestRadius[kMaxClasses]; // per class: float bits of the largest radius [m] of its finite spheres;
                                     // 0 = none. Only with a tree
};
FATHOM_SIZE(FrameCounters, 224);

// Moments of one guidance class in one patch, about their mean = anchor + offset. A single float32 mean would
// lose digits that the covariance of a small class needs.
struct PatchMoments {
    vec4 anchor; // a point of the class, base axes, relative to the origin [m]; w = count
    vec4 offset; // mean - anchor [m]
    vec4 first;  // sums of xx, xy, xz, yy [m^2]
    vec4 second; // sums of yz, zz; -, -
};
FATHOM_SIZE(PatchMoments, 64);

// The device's bounds of spheres: those of 4x4 pixels, in the order of the patches, then those of the
// patches.
struct TreeParams {
    uint patches;    // their number
    uint firstPatch; // index of the first one's node
};
FATHOM_SIZE(TreeParams, 8);

FATHOM_SHARED_END
#endif
