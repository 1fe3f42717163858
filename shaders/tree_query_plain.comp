#version 460
// SPDX-License-Identifier: Apache-2.0
// Contact query on devices without subgroup arithmetic: one place in the answer per sphere with a result.
#extension GL_GOOGLE_include_directive : require
#include "shaders/lib/tree_query.glsl"

Place placeOf(uint pairs) {
    return pairs != 0u ? Place(atomicAdd(counts.x, 1u), atomicAdd(counts.y, pairs)) : Place(0, 0);
}

void main() {
    queryBlocks();
}
