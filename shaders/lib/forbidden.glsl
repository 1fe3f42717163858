// SPDX-License-Identifier: Apache-2.0
// The class whose sphere a pixel gets. Needs params, masks, points.

const uint kNone = 0xffu;

// Largest radius, then file order: params.time.w lists the forbidden classes so, four bits each, 15 ends the list.
uint forbiddenClass(uint mask) {
    uint order = params.time.w;
    for (uint i = 0; i < kMaxClasses; ++i) {
        uint c = (order >> (4u * i)) & 15u;
        if (c == 15u) {
            return kNone;
        }
        if ((mask >> c & 1u) != 0) {
            return c;
        }
    }
    return kNone;
}

// Class of the kept forbidden point in a slot, kNone when there is none.
uint forbiddenAt(uint slot) {
    uint mask = masks[slot] & params.depthBand.w;
    return mask != 0 && points[slot].w != 0.0 ? forbiddenClass(mask) : kNone;
}
