// SPDX-License-Identifier: Apache-2.0
// What the decisions of thinning mean for each point.

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

// What the sphere of pixel p (0..15) of a 4x4 cell grows by, -1 when the point is left out. Corners of 4x4 cells always stay;
// corners of 2x2 cells stay unless every 4x4 cell that they touch was thinned as one; the rest stays unless its own cell was
// thinned.
float keptGrowth(const uint p, CellsAround c) {
    bool right = (p & 2u) != 0, low = (p & 8u) != 0; // half of the 4x4 cell
    uint q = (low ? 2u : 0u) + (right ? 1u : 0u);
    float own = quarterGrowth(c.own, q);
    if ((p & 5u) != 0) {
        return any(bvec2(isWhole(c.own), own > 0.0)) ? -1.0 : 0.0;
    }
    // The 2x2 cells left, above and across, in whichever 4x4 cell they lie.
    vec4 leftCell = right ? c.own : c.left, upCell = low ? c.own : c.up;
    vec4 acrossCell = right ? (low ? c.own : c.up) : (low ? c.left : c.corner);
    float grown = max(max(own, quarterGrowth(leftCell, q ^ 1u)), max(quarterGrowth(upCell, q ^ 2u), quarterGrowth(acrossCell, q ^ 3u)));
    if ((p & 10u) != 0) {
        return all(bvec3(isWhole(c.own), isWhole(leftCell), isWhole(upCell))) ? -1.0 : grown;
    }
    float whole = -min(min(c.own.x, c.left.x), min(c.up.x, c.corner.x));
    return max(grown, whole);
}
