// SPDX-License-Identifier: Apache-2.0
// Nodes of the region tree from their 4x4 children: centre = mean of all points below, radius = max(|c_k -
// centre| + r_k) over the children (paper eq. 3). Needs `tree` (TreeParams), and coherent `nodes` and
// `nodeCounts`.

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

// All children are read before the first use: a node costs one memory latency instead of 32.
void buildNode(uint level, uint index, Children below) {
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
}

// The levels above the patches, by one group.
void buildAbovePatches() {
    for (uint level = 2u; level < tree.run.x; ++level) {
        uint count = tree.levels[level].x * tree.levels[level].y;
        for (uint i = gl_LocalInvocationID.x; i < count; i += gl_WorkGroupSize.x) {
            buildNode(level, i, nodesBelow(level, i));
        }
        memoryBarrierBuffer();
        barrier();
    }
}
