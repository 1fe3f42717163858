// SPDX-License-Identifier: Apache-2.0
// Parameters and results of one contact query.
#ifndef FATHOM_SHARED_QUERY_PARAMS_H
#define FATHOM_SHARED_QUERY_PARAMS_H
#include "shaders/shared/interop.h"
FATHOM_SHARED_BEGIN

// A block is 256 slots of spheres with one bound: a patch of an image, or part of a list.
FATHOM_CONST kBlockSlots = 256, // slots per block
    kSliceLeaves = 512;         // most leaves that one group tests
// A leaf in the answer: leaf x kBands + band of its gap, plus kUndecided where float32 is too coarse to tell
// the band, or whether the gap is within reach.
FATHOM_CONST kBands = 16,    // of a leaf
    kUndecided = 0x80000000; // float32 does not decide this pair
// FoundSphere::slot is 4 x slot + layer.
FATHOM_CONST kLayerSeen = 0, // spheres of this frame
    kLayerHeld = 1,          // held spheres
    kLayerFrozen = 2;        // spheres of frozen classes

// Push constants. q = rows * (s - t) transforms a sphere's centre into the frame of the leaves.
struct QueryParams {
    vec4 rows[3];        // a row of the rotation; one component of t [m]
    vec4 tool;           // bounds all leaves, in their frame
    uvec4 blocks;        // number of blocks; index of the first bound; number of leaves; leaves per slice
    uvec4 used;          // spheres and leaves found before this query; most of each in this one
    uint layer;          // of the first layer: kLayerSeen or kLayerFrozen
    uint layers;         // 2 = `held` is a second layer
    uint leafWord;       // index of the first leaf in the answer [words]
    float reach;         // [m] outwardReach()
    float bandsPerMetre; // kBands / reach of the set
    float margin;        // [m] searchError()
};
FATHOM_SIZE(QueryParams, 120);

// A sphere with the leaves that are near it.
struct FoundSphere {
    uint slot, pointClass; // slot: 4 x slot + layer
    uint first, count;     // of its leaves in the answer
    vec4 sphere;           // as in the set
};
FATHOM_SIZE(FoundSphere, 32);

FATHOM_SHARED_END
#endif
