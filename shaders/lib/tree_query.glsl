// SPDX-License-Identifier: Apache-2.0
// Contact query (paper V.A): lists every pair of region sphere and tool leaf whose gap may be at most the
// reach. Both trees are searched breadth first and in parallel. A group tests the bounds of its blocks
// against the bound of the tool, and then, for each block in reach, its slice of leaves against the block's
// bound. The leaves in reach go to shared memory, and one invocation per sphere tests them.
//
// The answer contains every pair within reach, and a few more. Each has the band of its gap, or the mark that
// float32 cannot tell it: then the host decides (engine/contact/near_pairs.h). docs/architecture/query.md
// proves the margins. The including file defines placeOf().
#include "shaders/lib/near_test.glsl"
#include "shaders/shared/constants.h"
#include "shaders/shared/query_params.h"

layout(local_size_x_id = kSpecGroupSize) in; // divides 256
layout(constant_id = kSpecClasses) const uint kClasses = 1;

layout(push_constant) uniform Push { QueryParams query; };
layout(std430, binding = 0) readonly buffer Leaves { vec4 leaves[]; };   // in their own frame
layout(std430, binding = 1) readonly buffer Bounds { vec4 bounds[]; };   // R < 0 = an empty block
layout(std430, binding = 2) readonly buffer Spheres { vec4 spheres[]; }; // slot -> centre, R; R < 0 = none
layout(std430, binding = 3) readonly buffer Held { vec4 held[]; };       // the same for held points
layout(std430, binding = 4) readonly buffer Classes { uint classes[]; }; // bytes: class, held class << 4
// counts: spheres and leaves found since the answer was created. They only grow, so that no pass clears them.
layout(std430, binding = 5) buffer Found { uvec4 counts; FoundSphere found[]; };
layout(std430, binding = 6) writeonly buffer FoundLeaves { uint foundLeaves[]; }; // the same buffer in words

#include "shaders/lib/slot_class.glsl"

struct Place {
    uint sphere, pair; // in the answer, counted since it was created
};
Place placeOf(uint pairs); // called in uniform control flow

shared uint blocksInReach, leavesInReach;
shared uint blockInReach[gl_WorkGroupSize.x];
shared vec4 boundInReach[gl_WorkGroupSize.x]; // in the frame of the leaves
shared vec4 leafInReach[kSliceLeaves];
shared uint idInReach[kSliceLeaves];

bool within(vec4 a, vec4 b) {
    return nearerThan(query.reach, a, b);
}

vec3 inLeafFrame(vec3 s) {
    return inFrameOf(query.rows, s);
}

// Group g of n has the blocks g, g + n, g + 2 n, ...: adjacent blocks, which are in reach together, have
// different groups. Lists those from `first` on that are in reach, one per invocation.
void listBlocks(uint first) {
    barrier();
    if (gl_LocalInvocationID.x == 0) {
        blocksInReach = 0;
    }
    barrier();
    uint block = first + gl_LocalInvocationID.x * gl_NumWorkGroups.x;
    if (block < query.blocks.x) {
        vec4 bound = bounds[query.blocks.y + block];
        vec4 here = vec4(inLeafFrame(bound.xyz), bound.w * 1.00001); // covers the rounding of the bound
        if (bound.w >= 0.0 && within(here, query.tool)) {
            uint at = atomicAdd(blocksInReach, 1u);
            blockInReach[at] = block;
            boundInReach[at] = here;
        }
    }
    barrier();
}

void listLeaves(vec4 bound) {
    barrier();
    if (gl_LocalInvocationID.x == 0) {
        leavesInReach = 0;
    }
    barrier();
    uint from = gl_WorkGroupID.y * query.blocks.w, to = min(from + query.blocks.w, query.blocks.z);
    for (uint i = from + gl_LocalInvocationID.x; i < to; i += gl_WorkGroupSize.x) {
        vec4 leaf = leaves[i];
        if (within(leaf, bound)) {
            uint at = atomicAdd(leavesInReach, 1u);
            leafInReach[at] = leaf;
            idInReach[at] = i;
        }
    }
    barrier();
}

// The leaf as the answer names it.
uint withBand(uint leaf, vec4 a, vec4 b) {
    float gap = gapBetween(a, b);
    precise float low = (gap - query.margin) * query.bandsPerMetre;
    precise float high = (gap + query.margin) * query.bandsPerMetre;
    const float last = float(kBands) - 0.5;
    uint band = uint(clamp(high, 0.0, last));
    bool decided = high <= float(kBands) && band == uint(clamp(low, 0.0, last));
    return leaf * kBands + (decided ? band : kUndecided);
}

void testSphere(uint slot, uint layer, uint near) {
    vec4 sphere = layer == kLayerHeld ? held[slot] : spheres[slot];
    vec4 here = vec4(inLeafFrame(sphere.xyz), sphere.w);
    uint pairs = 0;
    for (uint k = 0; k < near && sphere.w >= 0.0; ++k) {
        pairs += within(here, leafInReach[k]) ? 1u : 0u;
    }
    Place place = placeOf(pairs);
    if (pairs == 0u) {
        return;
    }
    uint at = place.sphere - query.used.x, pair = place.pair - query.used.y;
    if (at < query.used.z) {
        found[at] = FoundSphere(slot * 4u + layer, classOf(slot, layer), pair, pairs, sphere);
    }
    for (uint k = 0; k < near; ++k) {
        if (within(here, leafInReach[k])) {
            if (pair < query.used.w) {
                foundLeaves[query.leafWord + pair] = withBand(idInReach[k], here, leafInReach[k]);
            }
            ++pair;
        }
    }
}

void testBlock(uint block, vec4 bound) {
    listLeaves(bound);
    uint near = leavesInReach;
    if (near == 0u) {
        return;
    }
    for (uint layer = 0; layer < query.layers; ++layer) {
        for (uint i = gl_LocalInvocationID.x; i < kBlockSlots; i += gl_WorkGroupSize.x) {
            testSphere(block * kBlockSlots + i, query.layer + layer, near);
        }
    }
}

void queryBlocks() {
    for (uint first = gl_WorkGroupID.x; first < query.blocks.x; first += gl_NumWorkGroups.x * gl_WorkGroupSize.x) {
        listBlocks(first);
        uint count = blocksInReach;
        for (uint k = 0; k < count; ++k) {
            testBlock(blockInReach[k], boundInReach[k]);
        }
    }
}
