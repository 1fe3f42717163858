#version 460
// SPDX-License-Identifier: Apache-2.0
// Contact query on devices with subgroup arithmetic. Results are compacted by subgroup: one place in the
// answer per subgroup with a result.
#extension GL_GOOGLE_include_directive : require
#extension GL_KHR_shader_subgroup_basic : require
#extension GL_KHR_shader_subgroup_arithmetic : require
#include "shaders/lib/tree_query.glsl"

Place placeOf(uint pairs) {
    uvec2 here = uvec2(pairs != 0u ? 1u : 0u, pairs);
    uvec2 before = subgroupExclusiveAdd(here), all = subgroupAdd(here), base = uvec2(0);
    if (all.x != 0u) {
        if (subgroupElect()) {
            base = uvec2(atomicAdd(counts.x, all.x), atomicAdd(counts.y, all.y));
        }
        base = subgroupAdd(base); // only the elected invocation's is not 0
    }
    return Place(base.x + before.x, base.y + before.y);
}

void main() {
    queryBlocks();
}
