#version 460
// SPDX-License-Identifier: Apache-2.0
// Smallest gap between the tool and the region spheres, one group per pose.
//   1. Seed: the sphere nearest to the tool's middle, in the block with the nearest bound, against all
//      leaves.
//   2. Tighten: each block whose bound is nearer than the smallest gap so far, its leaves likewise.
//   3. List: every pair whose rounded gap exceeds the result of 2. by at most a margin. The pair with the
//      smallest gap is one of them, whatever 2. missed or rounded, because the gap of 2. belongs to some
//      pair. The host decides in float64 (docs/architecture/query.md).
#extension GL_GOOGLE_include_directive : require
#include "shaders/lib/near_test.glsl"
#include "shaders/shared/constants.h"
#include "shaders/shared/gap_params.h"
#include "shaders/shared/query_params.h"

layout(local_size_x_id = kSpecGroupSize) in; // divides 256
layout(constant_id = kSpecClasses) const uint kClasses = 1;

layout(push_constant) uniform Push { GapParams batch; };
layout(std430, binding = 0) readonly buffer Leaves { vec4 leaves[]; };   // in their own frame
layout(std430, binding = 1) readonly buffer Bounds { vec4 bounds[]; };   // R < 0 = an empty block
layout(std430, binding = 2) readonly buffer Spheres { vec4 spheres[]; }; // slot -> centre, R; R < 0 = none
layout(std430, binding = 3) readonly buffer Held { vec4 held[]; };       // the same for held points
layout(std430, binding = 4) readonly buffer Classes { uint classes[]; }; // bytes: class, held class << 4
layout(std430, binding = 5) readonly buffer Frozen { vec4 frozen[]; };   // slots, then bounds
layout(std430, binding = 6) readonly buffer Poses { GapPose poses[]; };
layout(std430, binding = 7) buffer Found { uvec4 count; GapPair found[]; };

#include "shaders/lib/slot_class.glsl"

const float kFar = 1e18; // [m] no gap yet; its square is a float
const uint kNoIndex = 0xffffffffu;

vec4 rows[3];              // of the pose
shared uint best, nearest; // keyOf() a gap; an index
shared uint blocksListed, leavesListed;
shared uint blockListed[gl_WorkGroupSize.x];
shared vec4 boundListed[gl_WorkGroupSize.x]; // in the frame of the leaves
shared vec4 leafListed[kSliceLeaves];
shared uint idListed[kSliceLeaves];

// Unsigned numbers in the order of the floats.
uint keyOf(float gap) {
    uint bits = floatBitsToUint(gap);
    return (bits & 0x80000000u) != 0u ? ~bits : bits | 0x80000000u;
}
float gapOf(uint key) {
    return uintBitsToFloat((key & 0x80000000u) != 0u ? key & 0x7fffffffu : ~key);
}

// Blocks of this frame first, then those of frozen classes.
uint blockCount() {
    return batch.blocks.x + batch.frozenBlocks.x;
}
vec4 boundOf(uint block) {
    bool seen = block < batch.blocks.x;
    vec4 bound = vec4(0.0, 0.0, 0.0, -1.0);
    if (seen) {
        bound = bounds[batch.blocks.y + block];
    } else if (block < blockCount()) {
        bound = frozen[batch.frozenBlocks.y + block - batch.blocks.x];
    }
    return vec4(inFrameOf(rows, bound.xyz), bound.w * 1.00001); // rounding of the bound
}
uint layersOf(uint block) {
    return block < batch.blocks.x ? batch.blocks.z : 1u;
}

struct Candidate {
    vec4 sphere, here; // as in the set; in the frame of the leaves; R < 0 = none
    uint slot, pointClass;
};
Candidate candidateOf(uint block, uint layer, uint i) {
    Candidate c;
    c.pointClass = 0u;
    if (block >= batch.blocks.x) {
        uint slot = (block - batch.blocks.x) * kBlockSlots + i;
        c.slot = slot * 4u + kLayerFrozen;
        c.sphere = frozen[slot];
    } else {
        uint slot = block * kBlockSlots + i;
        c.slot = slot * 4u + layer;
        c.sphere = layer == kLayerHeld ? held[slot] : spheres[slot];
        c.pointClass = classOf(slot, layer);
        c.sphere.w = (batch.blocks.w >> c.pointClass & 1u) != 0u ? -1.0 : c.sphere.w;
    }
    c.here = vec4(inFrameOf(rows, c.sphere.xyz), c.sphere.w);
    return c;
}

// Index with the smallest gap of all invocations; kNoIndex without any below kFar.
uint nearestOf(float gap, uint index) {
    barrier();
    if (gl_LocalInvocationID.x == 0u) {
        best = keyOf(kFar);
        nearest = kNoIndex;
    }
    barrier();
    atomicMin(best, keyOf(gap));
    barrier();
    if (keyOf(gap) == best && gap < kFar) {
        atomicMin(nearest, index);
    }
    barrier();
    return nearest;
}

uint nearestBlock() {
    float least = kFar;
    uint which = kNoIndex;
    for (uint block = gl_LocalInvocationID.x; block < blockCount(); block += gl_WorkGroupSize.x) {
        vec4 bound = boundOf(block);
        float gap = bound.w >= 0.0 ? gapBetween(bound, batch.tool) : kFar;
        which = gap < least ? block : which;
        least = min(least, gap);
    }
    return nearestOf(least, which);
}

uint nearestSphere(uint block) {
    float least = kFar;
    uint which = kNoIndex;
    for (uint i = gl_LocalInvocationID.x; i < layersOf(block) * kBlockSlots; i += gl_WorkGroupSize.x) {
        vec4 here = candidateOf(block, i / kBlockSlots, i % kBlockSlots).here;
        float gap = here.w >= 0.0 ? gapBetween(here, batch.tool) : kFar;
        which = gap < least ? i : which;
        least = min(least, gap);
    }
    return nearestOf(least, which);
}

void seed() {
    uint block = nearestBlock();
    uint which = block != kNoIndex ? nearestSphere(block) : kNoIndex;
    barrier();
    if (gl_LocalInvocationID.x == 0u) {
        best = keyOf(kFar);
    }
    barrier();
    if (which != kNoIndex) {
        vec4 here = candidateOf(block, which / kBlockSlots, which % kBlockSlots).here;
        float least = kFar;
        for (uint i = gl_LocalInvocationID.x; i < batch.frozenBlocks.z; i += gl_WorkGroupSize.x) {
            least = min(least, gapBetween(here, leaves[i]));
        }
        atomicMin(best, keyOf(least));
    }
    barrier();
}

// Blocks from `first` on that are near, one per invocation. Group-uniform, like all functions below.
void listBlocks(uint first, float limit) {
    barrier();
    if (gl_LocalInvocationID.x == 0u) {
        blocksListed = 0u;
    }
    barrier();
    uint block = first + gl_LocalInvocationID.x;
    vec4 bound = boundOf(block);
    if (bound.w >= 0.0 && nearerThan(limit, bound, batch.tool)) {
        uint at = atomicAdd(blocksListed, 1u);
        blockListed[at] = block;
        boundListed[at] = bound;
    }
    barrier();
}

void listLeaves(uint from, vec4 bound, float limit) {
    if (gl_LocalInvocationID.x == 0u) {
        leavesListed = 0u;
    }
    barrier();
    uint to = min(from + kSliceLeaves, batch.frozenBlocks.z);
    for (uint i = from + gl_LocalInvocationID.x; i < to; i += gl_WorkGroupSize.x) {
        vec4 leaf = leaves[i];
        if (nearerThan(limit, leaf, bound)) {
            uint at = atomicAdd(leavesListed, 1u);
            leafListed[at] = leaf;
            idListed[at] = i;
        }
    }
    barrier();
}

void tighten(uint block, uint near, float limit) {
    float least = limit;
    for (uint i = gl_LocalInvocationID.x; i < layersOf(block) * kBlockSlots; i += gl_WorkGroupSize.x) {
        vec4 here = candidateOf(block, i / kBlockSlots, i % kBlockSlots).here;
        bool inReach = here.w >= 0.0 && nearerThan(least, here, batch.tool);
        for (uint k = 0u; k < near && inReach; ++k) {
            if (nearerThan(least, here, leafListed[k])) {
                least = min(least, gapBetween(here, leafListed[k]));
            }
        }
    }
    if (least < limit) {
        atomicMin(best, keyOf(least));
    }
}

void list(uint block, uint near, float limit) {
    for (uint i = gl_LocalInvocationID.x; i < layersOf(block) * kBlockSlots; i += gl_WorkGroupSize.x) {
        Candidate c = candidateOf(block, i / kBlockSlots, i % kBlockSlots);
        bool inReach = c.here.w >= 0.0 && nearerThan(limit, c.here, batch.tool);
        for (uint k = 0u; k < near && inReach; ++k) {
            if (nearerThan(limit, c.here, leafListed[k])) {
                uint at = atomicAdd(count.x, 1u);
                if (at < batch.frozenBlocks.w) {
                    found[at] = GapPair(gl_WorkGroupID.x, idListed[k], c.slot, c.pointClass, c.sphere);
                }
            }
        }
    }
}

// listed: the limit of the third step; kFar in the second, which has a limit that falls.
void searchBlock(uint block, vec4 bound, float listed) {
    for (uint from = 0u; from < batch.frozenBlocks.z; from += kSliceLeaves) {
        barrier(); // no invocation changes `best` until the next one
        float limit = listed < kFar ? listed : gapOf(best);
        if (nearerThan(limit, bound, batch.tool)) {
            listLeaves(from, bound, limit);
            if (leavesListed != 0u && listed < kFar) {
                list(block, leavesListed, limit);
            } else if (leavesListed != 0u) {
                tighten(block, leavesListed, limit);
            }
        }
    }
}

void searchAll(float listed) {
    for (uint first = 0u; first < blockCount(); first += gl_WorkGroupSize.x) {
        barrier();
        listBlocks(first, listed < kFar ? listed : gapOf(best));
        uint blocks = blocksListed;
        for (uint k = 0u; k < blocks; ++k) {
            searchBlock(blockListed[k], boundListed[k], listed);
        }
    }
    barrier();
}

void main() {
    GapPose pose = poses[gl_WorkGroupID.x];
    rows = pose.rows;
    seed();
    searchAll(kFar);
    float gap = gapOf(best);
    if (gap < kFar) {
        searchAll(gap + (pose.margin.x + max(gap, 0.0) * (1.0 / float(kGapSlope))));
    }
}
