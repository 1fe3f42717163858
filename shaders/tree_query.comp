#version 460
// SPDX-License-Identifier: Apache-2.0
// Contact query (paper V.A): finds every region sphere whose gap to some tool leaf is at most the reach. One
// invocation per sub-patch of the region tree. It tests the sub-patch's ancestors, from the root down,
// against the root of the tool tree. If all collide, it tests the sub-patch's bound and then its spheres down
// the tool tree to the leaves. Any subgroup size.
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/constants.h"
#include "shaders/shared/query_params.h"

layout(local_size_x_id = kSpecGroupSize) in;

layout(std140, binding = 0) uniform Query { QueryParams query; };
// Tool tree at the queried pose, breadth first; r < 0 = unused.
layout(std430, binding = 1) readonly buffer Tool { vec4 tool[]; };
layout(std430, binding = 2) readonly buffer Nodes { vec4 nodes[]; };
layout(std430, binding = 3) readonly buffer Spheres { vec4 spheres[]; };
layout(std430, binding = 4) readonly buffer Held { vec4 held[]; };
layout(std430, binding = 5) buffer Count { uint count[]; };           // spheres found, may exceed the capacity
layout(std430, binding = 6) writeonly buffer Found { uint found[]; }; // slot * 2 + layer, any order

// The deciding test, identical to the CPU's: same operations, same order, no contraction.
bool within(vec4 a, vec4 b, float reach) {
    precise float dx = a.x - b.x;
    precise float dy = a.y - b.y;
    precise float dz = a.z - b.z;
    precise float d2 = dx * dx + dy * dy + dz * dz;
    precise float limit = reach + a.w + b.w;
    precise float limit2 = limit * limit;
    return d2 <= limit2;
}

// Whether a sphere is within reach of some leaf. The tool tree is complete, of any degree. After a leaf, or a
// node that cannot collide, the traversal continues at the next sibling of the deepest ancestor that has one.
bool touchesTool(vec4 sphere) {
    uint degree = query.region.z, firstLeaf = query.region.w;
    float loose = query.reach.x * 1.00001 + 1e-6; // for inner nodes: rounded outward, as bounds must be
    uint node = 0;
    for (;;) {
        vec4 t = tool[node];
        bool leaf = node >= firstLeaf;
        if (t.w >= 0.0 && within(t, sphere, leaf ? query.reach.x : loose)) {
            if (leaf) {
                return true;
            }
            node = node * degree + 1u;
            continue;
        }
        while (node != 0 && (node - 1u) % degree == degree - 1u) { // last child: go up
            node = (node - 1u) / degree;
        }
        if (node == 0) {
            return false;
        }
        node += 1u;
    }
}

bool nodeInReach(uint node) {
    vec4 n = nodes[node];
    return n.w >= 0.0 && within(tool[0], n, query.reach.x * 1.00001 + 1e-6);
}

bool ancestorsInReach(uvec2 patchAt) {
    for (uint level = query.region.x; level-- > 1u;) {
        uvec4 here = query.levels[level];
        uvec2 at = patchAt >> (2u * (level - 1u));
        if (!nodeInReach(here.z + at.y * here.x + at.x)) {
            return false;
        }
    }
    return true;
}

void test(vec4 sphere, uint slot, uint layer) {
    if (sphere.w >= 0.0 && touchesTool(sphere)) {
        uint place = atomicAdd(count[0], 1u);
        if (place < query.size.w) {
            found[place] = slot * 2u + layer;
        }
    }
}

void main() {
    uint sub = gl_GlobalInvocationID.x;
    if (sub >= query.size.x * query.size.y * 16u) {
        return;
    }
    uint patchIndex = sub >> 4;
    if (!ancestorsInReach(uvec2(patchIndex % query.size.x, patchIndex / query.size.x)) || !nodeInReach(sub) ||
        !touchesTool(nodes[sub])) {
        return;
    }
    for (uint p = 0; p < 16u; ++p) {
        uint slot = sub * 16u + p;
        test(spheres[slot], slot, 0u);
        if (query.region.y != 0) {
            test(held[slot], slot, 1u);
        }
    }
}
