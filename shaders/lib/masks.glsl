// SPDX-License-Identifier: Apache-2.0
// Class bits of pixels: one byte per slot, one texel per sub-patch, one word per row of it. Needs masks.

uvec4 rowsOfMasks(uint sub) {
    return texelFetch(masks, int(sub));
}

// Class bits of the pixel in column x (0..3) of a row.
uint maskInRow(uint row, uint x) {
    return row >> (x * 8u) & 255u;
}

uint maskAt(uint slot) {
    return maskInRow(rowsOfMasks(slot >> 4)[slot >> 2 & 3u], slot & 3u);
}
