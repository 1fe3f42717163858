// SPDX-License-Identifier: Apache-2.0
// Reads the decisions of thin.comp. Needs params, listed, growth.

// Decision of the 4x4 cell at a pixel; all zero outside the picture and in patches without work.
vec4 cellAt(ivec2 at) {
    if (any(lessThan(at, ivec2(0))) || any(greaterThanEqual(at, ivec2(params.size.xy)))) {
        return vec4(0.0);
    }
    uvec2 p = uvec2(at);
    uint patchIndex = (p.y >> 4) * params.size.z + (p.x >> 4);
    return listed[patchIndex] == 0 ? vec4(0.0) : growth[patchIndex * 16u + ((p.y >> 2) & 3u) * 4u + ((p.x >> 2) & 3u)];
}

bool isWhole(vec4 cell) {
    return cell.x < 0.0;
}

// Growth asked for by the 2x2 cell at a pixel; 0 when it is kept whole or belongs to a thinned 4x4 cell.
float pairGrowth(ivec2 at) {
    vec4 cell = cellAt(at);
    return isWhole(cell) ? 0.0 : cell[(at.y & 2) + ((at.x & 2) >> 1)];
}

// What a point's sphere grows by, -1 when the point is left out. Corners of 4x4 cells always stay; corners of 2x2 cells stay
// unless every 4x4 cell that they touch was thinned as one; the rest stays unless its own cell was thinned.
float keptGrowth(uvec2 pixel) {
    ivec2 at = ivec2(pixel);
    vec4 own = cellAt(at);
    if ((at.x & 1) != 0 || (at.y & 1) != 0) {
        return isWhole(own) || pairGrowth(at & ~1) > 0.0 ? -1.0 : 0.0;
    }
    float grown = max(max(pairGrowth(at), pairGrowth(at - ivec2(2, 0))),
                      max(pairGrowth(at - ivec2(0, 2)), pairGrowth(at - ivec2(2, 2))));
    vec4 left = (at.x & 3) == 0 ? cellAt(at - ivec2(4, 0)) : own;
    vec4 up = (at.y & 3) == 0 ? cellAt(at - ivec2(0, 4)) : own;
    if ((at.x & 3) != 0 || (at.y & 3) != 0) {
        return isWhole(own) && isWhole(left) && isWhole(up) ? -1.0 : grown;
    }
    vec4 corner = cellAt(at - ivec2(4, 4));
    float whole = max(max(-1.0 - own.x, -1.0 - left.x), max(-1.0 - up.x, -1.0 - corner.x));
    return max(grown, whole);
}
