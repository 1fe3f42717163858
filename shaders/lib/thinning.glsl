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

// The four cells that decide about a pixel: its own, and those left, above and across the corner.
struct CellsAround {
    vec4 own, left, up, corner;
};

// Growth asked for by the 2x2 cell q (0..3, row-major) of a 4x4 cell; 0 when it is kept whole or the 4x4 cell was thinned.
float quarterGrowth(vec4 cell, uint q) {
    return isWhole(cell) ? 0.0 : (q < 2u ? (q == 0u ? cell.x : cell.y) : (q == 2u ? cell.z : cell.w));
}

// What a point's sphere grows by, -1 when the point is left out. Corners of 4x4 cells always stay; corners of 2x2 cells stay
// unless every 4x4 cell that they touch was thinned as one; the rest stays unless its own cell was thinned.
float keptGrowth(uvec2 pixel, CellsAround c) {
    bool right = (pixel.x & 2u) != 0, low = (pixel.y & 2u) != 0; // half of the 4x4 cell
    uint q = (low ? 2u : 0u) + (right ? 1u : 0u);
    float own = quarterGrowth(c.own, q);
    if ((pixel.x & 1u) != 0 || (pixel.y & 1u) != 0) {
        return isWhole(c.own) || own > 0.0 ? -1.0 : 0.0;
    }
    // The 2x2 cells left, above and across, in whichever 4x4 cell they lie.
    vec4 leftCell = right ? c.own : c.left, upCell = low ? c.own : c.up;
    vec4 acrossCell = right ? (low ? c.own : c.up) : (low ? c.left : c.corner);
    float grown = max(max(own, quarterGrowth(leftCell, q ^ 1u)), max(quarterGrowth(upCell, q ^ 2u), quarterGrowth(acrossCell, q ^ 3u)));
    if (right || low) {
        return isWhole(c.own) && isWhole(leftCell) && isWhole(upCell) ? -1.0 : grown;
    }
    float whole = max(max(-1.0 - c.own.x, -1.0 - c.left.x), max(-1.0 - c.up.x, -1.0 - c.corner.x));
    return max(grown, whole);
}
