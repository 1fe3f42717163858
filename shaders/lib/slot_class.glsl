// SPDX-License-Identifier: Apache-2.0
// The class of the sphere in a slot; layer: kLayerSeen or kLayerHeld.

uint classOf(uint slot, uint layer) {
    uint both = kClasses > 1u ? classes[slot >> 2] >> 8u * (slot & 3u) & 255u : 0u;
    return layer == kLayerHeld ? both >> 4 : both & 15u;
}
