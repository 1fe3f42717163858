// SPDX-License-Identifier: Apache-2.0
// The surface at a 4x4 sub-patch, with windows in registers: loads of CPU devices are gathers, lane by lane,
// so pixels share them. Makes the same decisions and sums in the same order as the form with one invocation
// per pixel. Needs what surface.comp defines before it.

// Size of the window with which pixels are rejected and filters of up to 5x5 are computed.
const int kWindowRadius = 2, kWindow = 4 + 2 * kWindowRadius;
// Larger filters go through rows of points: of the own four columns and kOwn on either side.
const int kFetches = int(kHalo + 3u) / 4, kOwn = 4 * kFetches, kRowWide = 4 + 2 * kOwn;

// Depths [m] of four adjacent pixels in a row. The first column must be a multiple of four.
vec4 fourDepths(ivec2 q) {
    if (kFour == 0) {
        return vec4(depthOfPixel(q), depthOfPixel(q + ivec2(1, 0)), depthOfPixel(q + ivec2(2, 0)), depthOfPixel(q + ivec2(3, 0)));
    }
    bool beyond = outside(q); // then all four pixels are
    uvec4 raw = texelFetch(depths, beyond ? 0 : int((uint(q.y) * depthWidth() + uint(q.x)) >> 2));
    vec4 z = metresOfFour(raw);
    return beyond ? vec4(0.0) : z;
}

// depth: of the four pixels in each row of the window [m].
void loadWindow(ivec2 at, out vec3 window[kWindow * kWindow], out vec4 depth[kWindow]) {
    [[unroll]] for (int y = 0; y < kWindow; ++y) {
        ivec2 left = at + ivec2(-4, y - kWindowRadius);
        vec4 before = fourDepths(left), own = fourDepths(left + ivec2(4, 0)), after = fourDepths(left + ivec2(8, 0));
        depth[y] = own;
        float z[kWindow] = float[kWindow](before.z, before.w, own.x, own.y, own.z, own.w, after.x, after.y);
        [[unroll]] for (int x = 0; x < kWindow; ++x) {
            window[y * kWindow + x] = windowPointAt(at + ivec2(x, y) - kWindowRadius, z[x]);
        }
    }
}

void loadRow(ivec2 at, out vec3 row[kRowWide]) {
    [[unroll]] for (int f = 0; f < kRowWide / 4; ++f) {
        ivec2 left = at + ivec2(4 * f - kOwn, 0);
        vec4 z = fourDepths(left);
        [[unroll]] for (int k = 0; k < 4; ++k) {
            row[4 * f + k] = windowPointAt(left + ivec2(k, 0), z[k]);
        }
    }
}

// Index in the window of pixel k (0..15, row-major) of the sub-patch.
int centreOf(int k) {
    return ((k >> 2) + kWindowRadius) * kWindow + (k & 3) + kWindowRadius;
}

// Difference from the earlier to the later point of the window, whichever is the centre. So two pixels need
// the same weight, and the compiler computes it once.
vec3 between(vec3 window[kWindow * kWindow], const int a, const int b) {
    return window[max(a, b)] - window[min(a, b)];
}

bool rejectedInWindow(vec3 window[kWindow * kWindow], const int centre) {
    float z[9], square[9];
    [[unroll]] for (int i = 0; i < 9; ++i) {
        const int at = centre + (i / 3 - 1) * kWindow + i % 3 - 1;
        vec3 apart = between(window, centre, at);
        z[i] = window[at].z;
        square[i] = dot(apart, apart);
    }
    return isRejected(z, square);
}

Mean meanInWindow(vec3 window[kWindow * kWindow], const int centre) {
    const int radius = min(int(kRadius), kWindowRadius);
    Mean mean = Mean(0.0, 0.0);
    [[unroll]] for (int dy = -radius; dy <= radius; ++dy) {
        [[unroll]] for (int dx = -radius; dx <= radius; ++dx) {
            const int at = centre + dy * kWindow + dx;
            vec3 apart = between(window, centre, at);
            mean = addToMean(mean, window[at].z - window[centre].z, weightOf(dot(apart, apart)));
        }
    }
    return mean;
}

// Adds a row of points to the means of the four pixels of row v.
void addRow(vec3 row[kRowWide], vec3 p[8], const int v, inout Mean mean[8]) {
    [[unroll]] for (int k = 4 * v; k < 4 * v + 4; ++k) {
        [[unroll]] for (int dx = -int(kRadius); dx <= int(kRadius); ++dx) {
            mean[k] = addWeighted(mean[k], row[kOwn + (k & 3) + dx], p[k]);
        }
    }
}

// Means of 4x2 pixels with the points p. Loads each row of points once for both rows of pixels. The loop has
// its condition at the end, because llvmpipe runs a body once more after a condition at the start has failed.
void meansFromRows(ivec2 at, vec3 p[8], out Mean mean[8]) {
    [[unroll]] for (int k = 0; k < 8; ++k) {
        mean[k] = Mean(0.0, 0.0);
    }
    vec3 row[kRowWide];
    loadRow(at - ivec2(0, kRadius), row);
    addRow(row, p, 0, mean);
    int y = 1 - int(kRadius);
    do {
        loadRow(at + ivec2(0, y), row);
        addRow(row, p, 0, mean);
        addRow(row, p, 1, mean);
    } while (++y <= int(kRadius));
    loadRow(at + ivec2(0, y), row);
    addRow(row, p, 1, mean);
}

// Points as measured, of all 16 pixels.
void plainBlock(uint sub) {
    ivec2 at = ivec2(pixelOfSlot(sub * 16u));
    uvec4 rows = rowsOfMasks(sub);
    [[unroll]] for (int y = 0; y < 4; ++y) {
        vec4 z = fourDepths(at + ivec2(0, y));
        [[unroll]] for (int x = 0; x < 4; ++x) {
            vec4 point = basePoint(at + ivec2(x, y), z[x]);
            points[sub * 16u + uint(4 * y + x)] = maskInRow(rows[y], uint(x)) != 0u ? point : vec4(0.0);
        }
    }
}

// Windows of up to 5x5: all 16 pixels.
void filterBlock(uint sub) {
    ivec2 at = ivec2(pixelOfSlot(sub * 16u));
    uvec4 rows = rowsOfMasks(sub);
    vec3 window[kWindow * kWindow];
    vec4 depth[kWindow];
    loadWindow(at, window, depth);
    [[unroll]] for (int k = 0; k < 16; ++k) {
        const int centre = centreOf(k);
        bool shown = all(bvec2(maskInRow(rows[k >> 2], uint(k & 3)) != 0u, !rejectedInWindow(window, centre)));
        float z = depth[kWindowRadius + (k >> 2)][k & 3];
        z = kRadius != 0u ? filteredDepth(meanInWindow(window, centre), window[centre], z) : z;
        vec4 point = basePoint(at + ivec2(k & 3, k >> 2), z);
        points[sub * 16u + uint(k)] = shown ? point : vec4(0.0);
    }
}

// Larger windows: two rows of a sub-patch, from slot on.
void filterTwoRows(uint slot) {
    ivec2 at = ivec2(pixelOfSlot(slot));
    uvec4 rows = rowsOfMasks(slot >> 4);
    uvec2 masks = (slot & 8u) != 0u ? rows.zw : rows.xy;
    vec3 window[kWindow * kWindow], p[8];
    vec4 depth[kWindow];
    loadWindow(at, window, depth);
    bool shown[8];
    [[unroll]] for (int k = 0; k < 8; ++k) {
        p[k] = window[centreOf(k)];
        shown[k] = all(bvec2(maskInRow(masks[k >> 2], uint(k & 3)) != 0u, !rejectedInWindow(window, centreOf(k))));
    }
    Mean mean[8];
    meansFromRows(at, p, mean);
    [[unroll]] for (int k = 0; k < 8; ++k) {
        float z = filteredDepth(mean[k], p[k], depth[kWindowRadius + (k >> 2)][k & 3]);
        vec4 point = basePoint(at + ivec2(k & 3, k >> 2), z);
        points[slot + uint(k)] = shown[k] ? point : vec4(0.0);
    }
}
