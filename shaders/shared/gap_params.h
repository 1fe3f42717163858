// SPDX-License-Identifier: Apache-2.0
// Parameters and results of a batch: the smallest gap of the tool at each of many poses.
#ifndef FATHOM_SHARED_GAP_PARAMS_H
#define FATHOM_SHARED_GAP_PARAMS_H
#include "shaders/shared/interop.h"
FATHOM_SHARED_BEGIN

// Pairs are listed up to g + GapPose::margin + max(g, 0) / kGapSlope, where g is the smallest gap in float32.
FATHOM_CONST kGapSlope = 65536;

// Push constants.
struct GapParams {
    vec4 tool;          // bounds all leaves, in their frame
    uvec4 blocks;       // number of blocks; index of the first bound; layers; bits of the classes to skip
    uvec4 frozenBlocks; // frozen blocks; index of the first of their bounds; leaves; most pairs of the answer
};
FATHOM_SIZE(GapParams, 48);

// One pose. q = rows * (s - t) transforms a sphere's centre into the frame of the leaves.
struct GapPose {
    vec4 rows[3]; // a row of the rotation; one component of t [m]
    vec4 margin;  // x: see kGapSlope [m]
};
FATHOM_SIZE(GapPose, 64);

// A pair that may have the smallest gap of its pose.
struct GapPair {
    uint pose, leaf;
    uint slot, pointClass; // slot: 4 x slot + layer, as FoundSphere
    vec4 sphere;           // as in the set
};
FATHOM_SIZE(GapPair, 32);

FATHOM_SHARED_END
#endif
