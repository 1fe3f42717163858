#version 460
// SPDX-License-Identifier: Apache-2.0
// Region spheres from their slots into one row without gaps, for the host: by patch, then layer (seen, held), then slot. One group a
// listed patch. What crosses the bus to a device of its own is as much as there are spheres, and in whole lines.
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/frame_params.h"

layout(local_size_x_id = 0) in;
layout(constant_id = 1) const uint kHold = 1; // 1: held spheres are a second layer

layout(std430, binding = 0) readonly buffer List { uint list[]; };
layout(std430, binding = 1) readonly buffer Begins { uint begins[]; };   // patch -> place of its first sphere
layout(std430, binding = 2) readonly buffer Spheres { vec4 spheres[]; }; // slot -> centre, R; R < 0 = none
layout(std430, binding = 3) readonly buffer Held { vec4 held[]; };
layout(std430, binding = 4) readonly buffer Classes { uint classes[]; }; // a byte a slot
layout(std430, binding = 5) writeonly buffer Packed { vec4 packedSpheres[]; };
layout(std430, binding = 6) writeonly buffer Tags { uint tags[]; }; // (patch * 512 + layer * 256 + slot in the patch) * 8 + class

const uint kPlaces = kHold != 0 ? 512u : 256u; // of a patch
shared uint present[16];                       // bit a place

vec4 sphereAt(uint patchIndex, uint place) {
    uint slot = patchIndex * 256u + (place & 255u);
    return kHold != 0 && place >= 256u ? held[slot] : spheres[slot];
}

// Spheres of the patch before this place.
uint rankOf(uint place) {
    uint rank = bitCount(present[place >> 5] & ((1u << (place & 31u)) - 1u));
    for (uint w = 0; w < place >> 5; ++w) {
        rank += bitCount(present[w]);
    }
    return rank;
}

void main() {
    uint patchIndex = list[gl_WorkGroupID.x];
    for (uint w = gl_LocalInvocationID.x; w < 16u; w += gl_WorkGroupSize.x) {
        present[w] = 0;
    }
    barrier();
    for (uint place = gl_LocalInvocationID.x; place < kPlaces; place += gl_WorkGroupSize.x) {
        if (sphereAt(patchIndex, place).w >= 0.0) {
            atomicOr(present[place >> 5], 1u << (place & 31u));
        }
    }
    barrier();
    for (uint place = gl_LocalInvocationID.x; place < kPlaces; place += gl_WorkGroupSize.x) {
        if ((present[place >> 5] >> (place & 31u) & 1u) != 0) {
            uint to = begins[patchIndex] + rankOf(place);
            uint slot = patchIndex * 256u + (place & 255u), both = classes[slot >> 2] >> ((slot & 3u) * 8u);
            packedSpheres[to] = sphereAt(patchIndex, place);
            tags[to] = (patchIndex * 512u + place) * 8u + ((place >= 256u ? both >> 4 : both) & 7u);
        }
    }
}
