// SPDX-License-Identifier: Apache-2.0
// Decides which points of a patch the error budget lets it remove, by one group. Per 4x4 cell, four
// invocations test the quarters and four others the whole cell. Needs masks, points, listed, growth,
// params.glsl, masks.glsl, forbidden.glsl, slots.glsl, thin_point.glsl, thinning.glsl, kThin, and
// `patchSpheres`, which contains the points until the cells are decided.

// Points per row: the patch's 4x4 cells, the cells left and above, and the corners of the next cells.
const uint kSide = 21u;
const uint kCells = 25u, kQuarters = 4u * kCells;
// R'^2 - R^2 per cell, from each of the four invocations that test it; then the growth per quarter; -1 = not
// thinned.
shared float requiredGrowth[kThin != 0 ? 2u * kQuarters : 1u];
shared vec4 cells[kThin != 0 ? kCells : 1u];          // decisions, encoded as `growth`; 5 per row

// Reads the points of a square of pixels into `patchSpheres`, w = forbidden class; kNone outside the image
// and in unlisted patches.
void readAround(ivec2 from) {
    for (uint i = gl_LocalInvocationID.x; i < kSide * kSide; i += gl_WorkGroupSize.x) {
        ivec2 at = from + ivec2(i % kSide, i / kSide);
        bool inside = all(lessThan(uvec2(at), depthSize())); // a negative number converts to a large one
        uint slot = slotOfPixel(inside ? uvec2(at) : uvec2(0));
        vec4 point = texelFetch(points, int(slot));
        uint mask = maskAt(slot) & forbiddenMask(), used = listed[slot >> 8];
        uint kind = forbiddenClass(all(bvec3(inside, used != 0, point.w != 0.0)) ? mask : 0u);
        patchSpheres[i] = vec4(point.xyz, float(kind));
    }
}

uint cornerOf(uint cell) {
    return (cell / 5u * kSide + cell % 5u) * 4u;
}

// The largest R'^2 - R^2 over the points that one lane tests. For a whole cell four lanes test five points
// each and the centre, rotated by 90 degrees from lane to lane. For a quarter one lane tests all five.
float requiredIn(uint cell, uint quarter, bool whole) {
    uvec2 corner = uvec2(quarter & 1u, quarter >> 1) * 2u;
    uint from = cornerOf(cell) + corner.y * kSide + corner.x;
    uint first = whole ? cornerOf(cell) : from, k = whole ? 4u : 2u;
    vec4 own = patchSpheres[first], right = patchSpheres[first + k], below = patchSpheres[first + k * kSide], across = patchSpheres[first + k * (kSide + 1u)];
    uint c = uint(own.w);
    float radius = radiusOf(c), most = 0.0, share = whole ? 0.25 : 0.5;
    Corners corners = cornersOf(own.xyz, right.xyz, below.xyz, across.xyz);
    ivec2 turn = quarter == 0u ? ivec2(1, 0) : (quarter == 1u ? ivec2(0, 1) : (quarter == 2u ? ivec2(-1, 0) : ivec2(0, -1)));
    bool full = all(bvec4(c != kNone, right.w == own.w, below.w == own.w, across.w == own.w));
    const ivec2 ofWhole[6] = ivec2[6](ivec2(0, 0), ivec2(1, 0), ivec2(2, 0), ivec2(1, 1), ivec2(2, 1), ivec2(2, -1));
    const ivec2 ofQuarter[6] = ivec2[6](ivec2(0, 0), ivec2(1, 0), ivec2(-1, 0), ivec2(0, 1), ivec2(0, -1), ivec2(0, 0));
    [[unroll]] for (uint i = 0; i < 6u; ++i) {
        ivec2 d = whole ? ofWhole[i] : ofQuarter[i];
        ivec2 at = ivec2(turn.x * d.x - turn.y * d.y, turn.y * d.x + turn.x * d.y) + int(k >> 1);
        vec4 q = patchSpheres[int(first) + at.y * int(kSide) + at.x];
        vec2 t = vec2(at) * share;
        most = max(most, requiredSquare(q.xyz, corners, t.x, t.y, radius));
        full = all(bvec2(full, q.w == own.w));
    }
    return full ? (whole ? most : growthOf(most, radius)) : -1.0;
}

vec4 decisionOf(uint cell) {
    uint a = cell * 4u;
    vec4 ofWhole = vec4(requiredGrowth[a], requiredGrowth[a + 1u], requiredGrowth[a + 2u], requiredGrowth[a + 3u]);
    a += kQuarters;
    vec4 quarters = max(vec4(0.0), vec4(requiredGrowth[a], requiredGrowth[a + 1u], requiredGrowth[a + 2u], requiredGrowth[a + 3u]));
    float least = min(min(ofWhole.x, ofWhole.y), min(ofWhole.z, ofWhole.w)), most = max(max(ofWhole.x, ofWhole.y), max(ofWhole.z, ofWhole.w));
    float whole = growthOf(max(most, 0.0), radiusOf(uint(patchSpheres[cornerOf(cell)].w)));
    return min(least, whole) >= 0.0 ? vec4(-whole, 0.0, 0.0, 0.0) : quarters;
}

// Called by the whole group. Afterwards `cells` is complete and `patchSpheres` is free.
void decideCells(uint patchIndex, ivec2 patchAt) {
    readAround(patchAt - 4);
    barrier();
    for (uint i = gl_LocalInvocationID.x; i < 2u * kQuarters; i += gl_WorkGroupSize.x) {
        uint quarter = i < kQuarters ? i : i - kQuarters;
        requiredGrowth[i] = requiredIn(quarter >> 2, quarter & 3u, i < kQuarters);
    }
    barrier();
    for (uint i = gl_LocalInvocationID.x; i < kCells; i += gl_WorkGroupSize.x) {
        uvec2 cell = uvec2(i % 5u, i / 5u);
        cells[i] = decisionOf(i);
        if (min(cell.x, cell.y) > 0u) { // a cell of this patch
            growth[patchIndex * 16u + (cell.y - 1u) * 4u + cell.x - 1u] = cells[i];
        }
    }
    barrier();
}

CellsAround cellsOfGroup(uint sub) {
    uint at = (sub >> 2) * 5u + (sub & 3u); // index of the diagonal cell
    return CellsAround(cells[at + 6u], cells[at + 5u], cells[at + 1u], cells[at]);
}
