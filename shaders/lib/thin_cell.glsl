// SPDX-License-Identifier: Apache-2.0
// Which points of a 4x4 cell the error budget can do without. Needs params, masks, points, listed, masks.glsl, forbidden.glsl,
// slots.glsl.
//
// A dropped point q with q' = sum l_i p_i, the bilinear mean of the cell's four corner points, V = sum l_i |p_i - q'|^2 and
// e = |q - q'| is covered by its corners when they have the radius R' = sqrt((R + e)^2 + V): for every x,
// min_i |x - p_i|^2 <= sum l_i |x - p_i|^2 = |x - q'|^2 + V. So corners that grow by R' - R lose nothing of the region, in any
// direction, on any slope; on a flat square of spacing s the growth is s^2 / (4 R). A cell is thinned only when it is full of
// one class and the growth stays within the budget: first 4x4, else each 2x2.

const uint kEdge = 5u; // points of a 4x4 cell with the corners of the next ones: 5 x 5, y * 5 + x
vec3 point[kEdge * kEdge];
uint kind[kEdge * kEdge]; // forbidden class, kNone

// The four sub-patches that the points lie in: own, right, below, across; their class bits, none outside the picture and in
// patches without work.
struct Quarter {
    uint slot; // of its first pixel
    uvec4 rows;
};

Quarter quarterAt(uvec2 at) {
    bool inside = all(lessThan(at, params.size.xy));
    uint slot = slotOfPixel(inside ? at : uvec2(0), params.size.z);
    uint used = listed[slot >> 8];
    uvec4 rows = rowsOfMasks(slot >> 4) & params.depthBand.w * 0x01010101u;
    return Quarter(slot, all(bvec2(inside, used != 0)) ? rows : uvec4(0));
}

// Everything is read before anything is looked at: one delay of the memory, not 25.
void readPoints(uvec2 at) {
    Quarter quarters[4] = Quarter[4](quarterAt(at), quarterAt(at + uvec2(4, 0)), quarterAt(at + uvec2(0, 4)), quarterAt(at + uvec2(4, 4)));
    float ranges[kEdge * kEdge];
    [[unroll]] for (uint i = 0; i < kEdge * kEdge; ++i) {
        const uint x = i % kEdge, y = i / kEdge;
        vec4 here = texelFetch(points, int(quarters[y / 4u * 2u + x / 4u].slot + (y & 3u) * 4u + (x & 3u)));
        point[i] = here.xyz, ranges[i] = here.w;
    }
    [[unroll]] for (uint i = 0; i < kEdge * kEdge; ++i) {
        const uint x = i % kEdge, y = i / kEdge;
        uint mark = maskInRow(quarters[y / 4u * 2u + x / 4u].rows[y & 3u], x & 3u);
        kind[i] = forbiddenClass(ranges[i] != 0.0 ? mark : 0u);
    }
}

// Growth within the budget that lets the k x k cell whose own corner is point `first` drop all but that corner; -1 = it is kept
// whole: not full of one class, or the budget does not allow it. Unrolled, and without a branch.
float thinned(const uint first, const uint k) {
    const uint c = kind[first];
    float radius = radiusOf(c);
    // About the own corner; sum l |p - mean|^2 = sum l |p|^2 - |mean|^2, and neighbours are near enough to keep its digits.
    vec3 a = point[first], b = point[first + k] - a, d = point[first + k * kEdge] - a, e = point[first + k * (kEdge + 1u)] - a;
    float bb = dot(b, b), dd = dot(d, d), ee = dot(e, e);
    uint others = c == kNone ? 1u : 0u;
    float most = 0.0; // R'^2 - R^2
    [[unroll]] for (uint i = 0; i < (k + 1u) * (k + 1u); ++i) {
        const uint x = i % (k + 1u), y = i / (k + 1u), at = first + y * kEdge + x;
        const float tx = float(x) / float(k), ty = float(y) / float(k);
        others |= kind[at] ^ c;
        vec3 mean = tx * (1.0 - ty) * b + (1.0 - tx) * ty * d + tx * ty * e;
        float spread = tx * (1.0 - ty) * bb + (1.0 - tx) * ty * dd + tx * ty * ee - dot(mean, mean);
        float off = distance(point[at] - a, mean);
        most = max(most, off * (2.0 * radius + off) + max(spread, 0.0));
    }
    // R' - R without the cancellation of two nearly equal radii; outward.
    float growth = most / (sqrt(radius * radius + most) + radius) * 1.0001 + 1e-8; // never 0
    return all(bvec2(others == 0u, growth <= params.filterParams.y)) ? growth : -1.0;
}

// Growth of the corners of the four 2x2 cells of the 4x4 cell at a pixel; x = -growth when it is thinned as one; 0 = kept whole.
vec4 decidedCell(uvec2 at) {
    readPoints(at);
    float whole = thinned(0u, 4u);
    vec4 quarters = max(vec4(0.0), vec4(thinned(0u, 2u), thinned(2u, 2u), thinned(2u * kEdge, 2u), thinned(2u * kEdge + 2u, 2u)));
    return whole >= 0.0 ? vec4(-whole, 0.0, 0.0, 0.0) : quarters;
}

// The same by any pixel; all zero outside the picture and in patches without work. Whoever asks gets the same.
vec4 decidedAt(ivec2 at) {
    bool inside = all(lessThan(uvec2(at), params.size.xy)); // below zero is beyond the end
    uvec2 p = inside ? uvec2(at) : uvec2(0);
    uint used = listed[(p.y >> 4) * params.size.z + (p.x >> 4)];
    return all(bvec2(inside, used != 0)) ? decidedCell(p) : vec4(0.0);
}
