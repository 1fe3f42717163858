#version 460
// SPDX-License-Identifier: Apache-2.0
// Lists the patches that `classify` marked and those whose memory holds points. One invocation per patch. CPU
// devices only: in `classify`, divergent lanes would all pay for the branches. On GPUs `classify` makes the
// lists.
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/constants.h"
#include "shaders/shared/frame_params.h"

layout(local_size_x_id = kSpecGroupSize) in;
layout(constant_id = kSpecHold) const uint kHold = 0;
layout(constant_id = kSpecGuidance) const uint kGuidance = 0;
layout(constant_id = kSpecSubPatchGroup) const uint kSubPatchGroup = 64;

layout(std140, binding = 0) uniform Params { FrameParams params; };
layout(std430, binding = 1) buffer Listed { uint listed[]; };               // patch -> kPatch bits
// Patch -> points in memory + 65536 x held points.
layout(std430, binding = 2) readonly buffer Memory { uint memoryCounts[]; };
// Patches in any order; frame_params.h describes its parts.
layout(std430, binding = 3) writeonly buffer List { uint list[]; };
layout(std430, binding = 4) buffer Counters { FrameCounters counters; };

#include "shaders/lib/params.glsl"
#include "shaders/lib/lists.glsl"

// Patches without held points have a separate list, so that `spheres` need not read their memory.
void putByMemory(uint patchIndex, uint patches) {
    if (memoryCounts[patchIndex] >> 16 != 0) {
        uint place = atomicAdd(counters.withHeldGroups.w, 1u);
        list[3u * patches - 1u - place] = patchIndex;
        atomicMax(counters.withHeldGroups.x, groupsUpTo(place, kSubPatchGroup));
    } else {
        uint place = atomicAdd(counters.withoutHeldGroups.w, 1u);
        list[2u * patches + place] = patchIndex;
        atomicMax(counters.withoutHeldGroups.x, groupsUpTo(place, kSubPatchGroup));
    }
}

void main() {
    uint patches = patchCount(), patchIndex = gl_GlobalInvocationID.x;
    if (patchIndex >= patches) {
        return;
    }
    uint bits = listed[patchIndex];
    if (kHold != 0 && memoryCounts[patchIndex] != 0) {
        bits |= kPatchListed;
        listed[patchIndex] = bits;
    }
    if ((bits & kPatchListed) != 0) {
        appendListed(patchIndex);
        if (kHold != 0) {
            putByMemory(patchIndex, patches);
        }
    }
    if (kGuidance != 0 && (bits & kPatchGuided) != 0) {
        uint place = atomicAdd(counters.guidedGroups.w, 1u);
        list[patches + place] = patchIndex;
        atomicMax(counters.guidedGroups.x, groupsUpTo(place, kSubPatchGroup));
    }
}
