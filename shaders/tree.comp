#version 460
// SPDX-License-Identifier: Apache-2.0
// Builds the region tree from patches up to one root, 4x4 children per node: centre = mean of all points
// below, radius = max(|c_k - centre| + r_k) over the children (paper eq. 3). One invocation per node. One
// group builds the top levels, with barriers between them.
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
#include "shaders/shared/constants.h"
#include "shaders/shared/frame_params.h"

layout(local_size_x_id = kSpecGroupSize) in;
layout(constant_id = kSpecPatches) const uint kPatches = 0;

layout(push_constant) uniform Push { TreeParams tree; } ;
layout(std430, binding = 0) readonly buffer Listed { uint listed[]; };
layout(std430, binding = 1) coherent buffer Nodes { vec4 nodes[]; };
layout(std430, binding = 2) coherent buffer NodeCounts { uint nodeCounts[]; };
layout(std430, binding = 3) buffer Counters { FrameCounters counters; };
// With kPatches: nodes and counts of the sub-patches, four counts per texel.
layout(binding = 4) uniform samplerBuffer subNodes;
layout(binding = 5) uniform usamplerBuffer subCounts;

// Index of child k of node `at` on `level`; kNoChild outside the level. No branch: a CPU device executes both
// sides of each.
const uint kNoChild = 0xffffffffu;
uint childOf(uvec2 at, uint level, uint k) {
    uvec4 below = tree.levels[level - 1u];
    uvec2 child = at * 4u + uvec2(k & 3u, k >> 2);
    return all(lessThan(child, below.xy)) ? below.z + child.y * below.x + child.x : kNoChild;
}

struct Children {
    vec4 node[16];
    uint count[16];
};

Children subPatchesOf(uint patchIndex) {
    Children c;
    bool used = listed[patchIndex] != 0u; // sub-patches of an unlisted patch contain old data
    [[unroll]] for (uint k = 0; k < 16u; ++k) {
        c.node[k] = texelFetch(subNodes, int(patchIndex * 16u + k));
    }
    [[unroll]] for (uint k = 0; k < 16u; k += 4u) {
        uvec4 four = texelFetch(subCounts, int(patchIndex * 4u + k / 4u));
        four = used ? four : uvec4(0);
        c.count[k] = four.x, c.count[k + 1u] = four.y, c.count[k + 2u] = four.z, c.count[k + 3u] = four.w;
    }
    return c;
}

Children nodesBelow(uint level, uint index) {
    uvec2 at = uvec2(index % tree.levels[level].x, index / tree.levels[level].x);
    Children c;
    [[unroll]] for (uint k = 0; k < 16u; ++k) {
        uint child = childOf(at, level, k);
        uint safe = child != kNoChild ? child : 0u;
        c.node[k] = nodes[safe];
        c.count[k] = child != kNoChild ? nodeCounts[safe] : 0u;
    }
    return c;
}

// Reads all children before the first use: a node costs one memory latency instead of 32.
void buildNode(uint level, uint index) {
    Children below;
    if (kPatches != 0) {
        below = subPatchesOf(index);
    } else {
        below = nodesBelow(level, index);
    }
    vec3 sum = vec3(0.0);
    uint count = 0;
    [[unroll]] for (uint k = 0; k < 16u; ++k) {
        sum += below.count[k] != 0 ? below.node[k].xyz * float(below.count[k]) : vec3(0.0);
        count += below.count[k];
    }
    vec3 centre = count != 0 ? sum / float(count) : vec3(0.0);
    float radius = -1.0;
    [[unroll]] for (uint k = 0; k < 16u; ++k) {
        float reach = distance(below.node[k].xyz, centre) + below.node[k].w;
        radius = below.count[k] != 0 ? max(radius, reach) : radius;
    }
    uint here = tree.levels[level].z + index;
    nodes[here] = vec4(centre, radius >= 0.0 ? radius * 1.000001 + 1e-7 : -1.0);
    nodeCounts[here] = count;
    if (count != 0) {
        atomicAdd(counters.nodes, 1u);
    }
}

void main() {
    for (uint level = tree.run.x; level <= tree.run.y; ++level) {
        uint count = tree.levels[level].x * tree.levels[level].y;
        for (uint i = gl_GlobalInvocationID.x; i < count; i += gl_NumWorkGroups.x * gl_WorkGroupSize.x) {
            buildNode(level, i);
        }
        memoryBarrierBuffer();
        barrier();
    }
}
