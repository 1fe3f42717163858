#version 460
// SPDX-License-Identifier: Apache-2.0
// Parents over 4x4 children, from patches up to one root: centre = mean of all points below, radius = max(|c_k - centre| + r_k)
// (paper eq. 3 with the children's spheres). One invocation a node; the top levels run in one group with barriers between.
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
#include "shaders/shared/frame_params.h"

layout(local_size_x_id = 0) in;

layout(push_constant) uniform Push { TreeParams tree; } ;
layout(std430, binding = 0) readonly buffer Listed { uint listed[]; };
layout(std430, binding = 1) coherent buffer Nodes { vec4 nodes[]; };
layout(std430, binding = 2) coherent buffer NodeCounts { uint nodeCounts[]; };
layout(std430, binding = 3) buffer Counters { FrameCounters counters; };
layout(std430, binding = 4) writeonly buffer Begins { uint begins[]; }; // patch -> spheres of the patches before it

// Index of child k of node `at` on `level`; kNoChild when it lies outside. No branch: a CPU device walks both sides of each.
const uint kNoChild = 0xffffffffu;
uint childOf(uvec2 at, uint level, uint k, uint index, uint used) {
    uvec4 below = tree.levels[level - 1u];
    uvec2 child = at * 4u + uvec2(k & 3u, k >> 2);
    uint above = all(lessThan(child, below.xy)) ? below.z + child.y * below.x + child.x : kNoChild;
    uint inPatch = used != 0u ? index * 16u + k : kNoChild; // sub-patches of an unlisted patch hold old data
    return level == 1u ? inPatch : above;
}

// All children are read before any is looked at: the reads are on their way together, a node costs one of their delays, not 32.
void buildNode(uint level, uint index) {
    uvec4 here = tree.levels[level];
    uvec2 at = uvec2(index % here.x, index / here.x);
    vec4 child[16];
    uint below[16], used = listed[level == 1u ? index : 0u];
    [[unroll]] for (uint k = 0; k < 16u; ++k) {
        uint c = childOf(at, level, k, index, used);
        uint safe = c != kNoChild ? c : 0u;
        child[k] = nodes[safe];
        below[k] = c != kNoChild ? nodeCounts[safe] : 0u;
    }
    vec3 sum = vec3(0.0);
    uint count = 0;
    [[unroll]] for (uint k = 0; k < 16u; ++k) {
        sum += below[k] != 0 ? child[k].xyz * float(below[k]) : vec3(0.0);
        count += below[k];
    }
    vec3 centre = count != 0 ? sum / float(count) : vec3(0.0);
    float radius = -1.0;
    [[unroll]] for (uint k = 0; k < 16u; ++k) {
        float reach = distance(child[k].xyz, centre) + child[k].w;
        radius = below[k] != 0 ? max(radius, reach) : radius;
    }
    nodes[here.z + index] = vec4(centre, radius >= 0.0 ? radius * 1.000001 + 1e-7 : -1.0);
    nodeCounts[here.z + index] = count;
    if (count != 0) {
        atomicAdd(counters.nodes, 1u);
    }
}

shared uint sums[1024]; // an invocation

// Where each patch's spheres begin once they are packed. One group: an invocation a run of patches.
void placePatches() {
    uint patches = tree.levels[1].x * tree.levels[1].y, me = gl_LocalInvocationID.x;
    uint each = (patches + gl_WorkGroupSize.x - 1u) / gl_WorkGroupSize.x;
    uint first = min(me * each, patches), end = min(first + each, patches), mine = 0;
    for (uint i = first; i < end; ++i) {
        mine += nodeCounts[tree.levels[1].z + i];
    }
    sums[me] = mine;
    barrier();
    for (uint step = 1; step < gl_WorkGroupSize.x; step *= 2u) { // running sums, in steps of twice the width
        uint before = me >= step ? sums[me - step] : 0u;
        barrier();
        sums[me] += before;
        barrier();
    }
    uint next = sums[me] - mine;
    for (uint i = first; i < end; ++i) {
        begins[i] = next;
        next += nodeCounts[tree.levels[1].z + i];
    }
    if (me == gl_WorkGroupSize.x - 1u) {
        counters.spheres = next;
    }
}

void main() {
    if (tree.run.w != 0) {
        placePatches();
    }
    for (uint level = tree.run.x; level <= tree.run.y; ++level) {
        uint count = tree.levels[level].x * tree.levels[level].y;
        for (uint i = gl_GlobalInvocationID.x; i < count; i += gl_NumWorkGroups.x * gl_WorkGroupSize.x) {
            buildNode(level, i);
        }
        memoryBarrierBuffer();
        barrier();
    }
}
