// SPDX-License-Identifier: Apache-2.0
// Applies the decisions of thinning to each point.

bool isWhole(vec4 cell) {
    return cell.x < 0.0;
}

// The four cells that affect a pixel: its own, left, above and diagonal.
struct CellsAround {
    vec4 own, left, up, corner;
};

// Growth [m] required by the 2x2 cell q (0..3, row-major) of a 4x4 cell; 0 when that cell is not thinned, or
// the 4x4 cell was thinned as one.
float quarterGrowth(vec4 cell, uint q) {
    return isWhole(cell) ? 0.0 : (q < 2u ? (q == 0u ? cell.x : cell.y) : (q == 2u ? cell.z : cell.w));
}

// Growth [m] of the sphere of pixel p (0..15) of a 4x4 cell; -1 when the point is dropped. Corners of 4x4
// cells are always kept. Corners of 2x2 cells are kept unless every 4x4 cell that they touch was thinned as
// one. Other points are kept unless their own cell was thinned.
float keptGrowth(const uint p, CellsAround c) {
    bool right = (p & 2u) != 0, low = (p & 8u) != 0; // half of the 4x4 cell
    uint q = (low ? 2u : 0u) + (right ? 1u : 0u);
    float own = quarterGrowth(c.own, q);
    if ((p & 5u) != 0) {
        return any(bvec2(isWhole(c.own), own > 0.0)) ? -1.0 : 0.0;
    }
    // The 2x2 cells left, above and diagonal, in whichever 4x4 cell contains them.
    vec4 leftCell = right ? c.own : c.left, upCell = low ? c.own : c.up;
    vec4 acrossCell = right ? (low ? c.own : c.up) : (low ? c.left : c.corner);
    float grown = max(max(own, quarterGrowth(leftCell, q ^ 1u)), max(quarterGrowth(upCell, q ^ 2u), quarterGrowth(acrossCell, q ^ 3u)));
    if ((p & 10u) != 0) {
        return all(bvec3(isWhole(c.own), isWhole(leftCell), isWhole(upCell))) ? -1.0 : grown;
    }
    float whole = -min(min(c.own.x, c.left.x), min(c.up.x, c.corner.x));
    return max(grown, whole);
}
