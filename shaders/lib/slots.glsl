// SPDX-License-Identifier: Apache-2.0
// A slot is the index of a pixel's results: patch-major, then 4x4 sub-patch, then pixel: slot = patch * 256 +
// sub * 16 + p. Needs params.glsl.

// Pixel in the patch for a slot in the patch (0..255).
uvec2 pixelInPatch(uint inside) {
    uint sub = inside >> 4, p = inside & 15u;
    return uvec2((sub & 3u) * 4u + (p & 3u), (sub >> 2) * 4u + (p >> 2));
}

uvec2 pixelOfSlot(uint slot) {
    uint patchIndex = slot >> 8;
    return uvec2(patchIndex % patchesAcross(), patchIndex / patchesAcross()) * 16u + pixelInPatch(slot & 255u);
}

uint slotOfPixel(uvec2 pixel) {
    uvec2 patchAt = pixel >> 4u, inside = pixel & 15u;
    uint sub = (inside.y >> 2) * 4u + (inside.x >> 2);
    return (patchAt.y * patchesAcross() + patchAt.x) * 256u + sub * 16u + (inside.y & 3u) * 4u + (inside.x & 3u);
}
