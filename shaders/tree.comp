#version 460
// SPDX-License-Identifier: Apache-2.0
// Bounds the patches on CPU devices, one invocation per patch: centre = mean of all spheres below, radius =
// max(|c_k - centre| + r_k) over its 4x4 sub-patches (paper eq. 3). On GPUs `spheres` bounds them.
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
#include "shaders/shared/constants.h"
#include "shaders/shared/frame_params.h"

layout(local_size_x_id = kSpecGroupSize) in;

layout(push_constant) uniform Push { TreeParams tree; };
layout(std430, binding = 0) readonly buffer Listed { uint listed[]; };
layout(std430, binding = 1) writeonly buffer Nodes { vec4 nodes[]; };
layout(std430, binding = 2) writeonly buffer NodeCounts { uint nodeCounts[]; };
// Nodes and counts of the sub-patches, four counts per texel.
layout(binding = 3) uniform samplerBuffer subNodes;
layout(binding = 4) uniform usamplerBuffer subCounts;

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
        c.count[k] = four.x;
        c.count[k + 1u] = four.y;
        c.count[k + 2u] = four.z;
        c.count[k + 3u] = four.w;
    }
    return c;
}

// All children are read before the first use: a node costs one memory latency instead of 32.
void buildNode(uint node, Children below) {
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
    nodes[node] = vec4(centre, radius >= 0.0 ? radius * 1.000001 + 1e-7 : -1.0);
    nodeCounts[node] = count;
}

void main() {
    uint patchIndex = gl_GlobalInvocationID.x;
    if (patchIndex < tree.patches) {
        buildNode(tree.firstPatch + patchIndex, subPatchesOf(patchIndex));
    }
}
