// SPDX-License-Identifier: Apache-2.0
// The surface at four adjacent pixels, with one row of their windows in registers at a time (radius > 2). Makes the same
// decisions and sums in the same order as the form with one invocation per pixel. Needs what surface.comp
// defines before it.

const int kFetches = int(kHalo + 3u) / 4; // of four depths, on either side of the own four
const int kRowWide = 4 + 8 * kFetches, kOwn = 4 * kFetches;

// Points of row y, from column at.x - kOwn.
void loadRow(ivec2 at, int y, out vec3 row[kRowWide]) {
    [[unroll]] for (int f = 0; f < kRowWide / 4; ++f) {
        ivec2 left = ivec2(at.x - kOwn + 4 * f, y);
        vec4 z = fourDepths(left);
        [[unroll]] for (int k = 0; k < 4; ++k) {
            row[4 * f + k] = pointAt(left + ivec2(k, 0), z[k]);
        }
    }
}

// Which of the four pixels are flying or isolated. own: their points.
bvec4 rejectedInRow(ivec2 at, out vec3 own[4]) {
    vec3 above[kRowWide], row[kRowWide], below[kRowWide];
    loadRow(at, at.y - 1, above);
    loadRow(at, at.y, row);
    loadRow(at, at.y + 1, below);
    bvec4 rejected;
    [[unroll]] for (int k = 0; k < 4; ++k) {
        const int c = kOwn + k;
        own[k] = row[c];
        rejected[k] = isRejected(vec3[9](above[c - 1], above[c], above[c + 1], row[c - 1], row[c], row[c + 1],
                                         below[c - 1], below[c], below[c + 1]));
    }
    return rejected;
}

// slot: of the first pixel.
void filterRow(uint slot) {
    ivec2 at = ivec2(pixelOfSlot(slot, params.size.z));
    uint word = rowsOfMasks(slot >> 4)[slot >> 2 & 3u];
    vec3 p[4];
    bvec4 rejected = rejectedInRow(at, p);
    Mean mean[4] = Mean[4](Mean(0.0, 0.0), Mean(0.0, 0.0), Mean(0.0, 0.0), Mean(0.0, 0.0));
    for (int dy = -int(kRadius); dy <= int(kRadius); ++dy) {
        vec3 row[kRowWide];
        loadRow(at, at.y + dy, row);
        [[unroll]] for (int k = 0; k < 4; ++k) {
            [[unroll]] for (int dx = -int(kRadius); dx <= int(kRadius); ++dx) {
                mean[k] = weighed(mean[k], row[kOwn + k + dx], p[k]);
            }
        }
    }
    [[unroll]] for (int k = 0; k < 4; ++k) {
        bool shown = all(bvec2(maskInRow(word, uint(k)) != 0u, !rejected[k]));
        vec4 result = basePoint(at + ivec2(k, 0), filteredDepth(mean[k], p[k]));
        points[slot + uint(k)] = shown ? result : vec4(0.0);
    }
}
