// SPDX-License-Identifier: Apache-2.0
// Class bits of pixels, a byte a slot. Needs masks.

uint maskAt(uint slot) {
    return masks[slot >> 2] >> ((slot & 3u) * 8u) & 255u;
}
