#version 460
// SPDX-License-Identifier: Apache-2.0
// Builds the region tree on CPU devices: one invocation per patch, or all levels above the patches by one
// group, with barriers between them. On GPUs `spheres` and `deliver` build these levels.
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
#include "shaders/shared/constants.h"
#include "shaders/shared/frame_params.h"

layout(local_size_x_id = kSpecGroupSize) in;
layout(constant_id = kSpecPatches) const uint kPatches = 0;

layout(push_constant) uniform Push { TreeParams tree; };
layout(std430, binding = 0) readonly buffer Listed { uint listed[]; };
layout(std430, binding = 1) coherent buffer Nodes { vec4 nodes[]; };
layout(std430, binding = 2) coherent buffer NodeCounts { uint nodeCounts[]; };
// With kPatches: nodes and counts of the sub-patches, four counts per texel.
layout(binding = 3) uniform samplerBuffer subNodes;
layout(binding = 4) uniform usamplerBuffer subCounts;

#include "shaders/lib/tree.glsl"

Children subPatchesOf(uint patchIndex) {
    Children c;
    bool used = listed[patchIndex] != 0u; // sub-patches of an unlisted patch contain old data
    [[unroll]] for (uint k = 0; k < 16u; ++k) {
        c.node[k] = texelFetch(subNodes, int(patchIndex * 16u + k));
    }
    [[unroll]] for (uint k = 0; k < 16u; k += 4u) {
        uvec4 four = texelFetch(subCounts, int(patchIndex * 4u + k / 4u));
        four = used ? four : uvec4(0);
        c.count[k] = four.x;
        c.count[k + 1u] = four.y;
        c.count[k + 2u] = four.z;
        c.count[k + 3u] = four.w;
    }
    return c;
}

void main() {
    if (kPatches == 0) {
        buildAbovePatches();
        return;
    }
    uint patchIndex = gl_GlobalInvocationID.x;
    if (patchIndex < tree.levels[1].x * tree.levels[1].y) {
        buildNode(1u, patchIndex, subPatchesOf(patchIndex));
    }
}
