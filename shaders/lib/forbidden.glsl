// SPDX-License-Identifier: Apache-2.0
// The class whose sphere a pixel gets. Needs params and kClasses, how many classes of
// points there are.

const uint kNone = 0xffu;

// Largest radius, then file order: params.time.w lists the forbidden classes so, four bits each, 15 ends the list. From the
// last to the first, the first that the mask has stays; no branch.
uint forbiddenClass(uint mask) {
    uint found = kNone;
    [[unroll]] for (uint i = 0; i < kClasses; ++i) {
        uint c = (params.time.w >> (4u * (kClasses - 1u - i))) & 15u;
        found = (mask >> c & 1u) != 0 ? c : found;
    }
    return found;
}

// Region radius [m] of a class; of the first for kNone. By selection: a CPU device reads a uniform index once, and a
// varying index lane by lane.
float radiusOf(uint c) {
    float radius = params.classes[0].role.x;
    [[unroll]] for (uint i = 1; i < kClasses; ++i) {
        radius = c == i ? params.classes[i].role.x : radius;
    }
    return radius;
}
