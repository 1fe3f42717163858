// SPDX-License-Identifier: Apache-2.0
// The class whose sphere a pixel gets. Needs params.glsl and kClasses, the number of point classes.

const uint kNone = 0xffu;

// The first forbidden class of the mask by largest radius, then file order. classOrder() lists classes in
// this order, four bits each; 15 ends the list. The loop runs backwards so that no branch is needed.
uint forbiddenClass(uint mask) {
    uint found = kNone;
    [[unroll]] for (uint i = 0; i < kClasses; ++i) {
        uint c = (classOrder() >> (4u * (kClasses - 1u - i))) & 15u;
        found = (mask >> c & 1u) != 0 ? c : found;
    }
    return found;
}

// Region radius [m] of a class; of the first one for kNone. Selects instead of indexing: a CPU device reads a
// varying index lane by lane.
float radiusOf(uint c) {
    float radius = params.classes[0].role.x;
    [[unroll]] for (uint i = 1; i < kClasses; ++i) {
        radius = c == i ? params.classes[i].role.x : radius;
    }
    return radius;
}
