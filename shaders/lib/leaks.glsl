// SPDX-License-Identifier: Apache-2.0
// Detects where a region leaks between two points. Needs params.glsl, counters, listed, points, masks.glsl,
// forbidden.glsl and slots.glsl.

// Records the largest leak: neighbours of one class on one surface that are at least R apart.
void noteLeak(uvec2 next, vec4 p, uint c) {
    if (any(greaterThanEqual(next, depthSize())) || listed[(next.y >> 4) * patchesAcross() + (next.x >> 4)] == 0) {
        return;
    }
    uint slot = slotOfPixel(next);
    vec4 q = texelFetch(points, int(slot));
    float apart = distance(p.xyz, q.xyz);
    bool surface = abs(q.w - p.w) <= 0.7 * apart; // steeper than 45 degrees counts as an edge
    bool same = forbiddenClass(q.w != 0.0 ? maskAt(slot) & forbiddenMask() : 0u) == c;
    if (all(bvec3(apart >= params.classes[c].role.x, surface, same))) {
        atomicMax(counters.leakSpacing[c], floatBitsToUint(apart));
        atomicMax(counters.leakRange[c], floatBitsToUint(p.w));
    }
}
