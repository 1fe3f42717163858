#version 460
// SPDX-License-Identifier: Apache-2.0
// Region spheres on CPU devices: one invocation per 4x4 sub-patch of a listed patch. Patches whose memory
// holds points have a dispatch of their own (kHold), so that the others need not read that memory.
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
#include "shaders/shared/constants.h"
#include "shaders/shared/frame_params.h"

layout(constant_id = kSpecHold) const uint kHold = 1;
// 1 on CPU devices only: an H100 was seen to fetch texels after the same dispatch had overwritten them.
layout(constant_id = kSpecTexels) const uint kTexels = 1;
const uint kPack = 0;

#include "shaders/lib/spheres.glsl"

layout(binding = 19) uniform samplerBuffer growth; // per sub-patch: the decision of thin.comp
// The memory of points as texels. Safe without barriers: each slot is used by one invocation, which reads it
// before it writes it.
layout(binding = 20) uniform samplerBuffer seenBefore;
layout(binding = 21) uniform samplerBuffer keptBefore;
layout(binding = 22) uniform usamplerBuffer keptTimeBefore;

vec4 seenAt(uint slot) {
    return kTexels != 0 ? texelFetch(seenBefore, int(slot)) : seen[slot];
}

vec4 keptAt(uint slot) {
    return kTexels != 0 ? texelFetch(keptBefore, int(slot)) : kept[slot];
}

uint keptTimeAt(uint slot) {
    return kTexels != 0 ? texelFetch(keptTimeBefore, int(slot)).x : keptTime[slot];
}

// Decision for the 4x4 cell at a pixel; all zero outside the image and in unlisted patches.
vec4 cellAt(ivec2 at) {
    bool inside = all(lessThan(uvec2(at), depthSize())); // a negative number converts to a large one
    uvec2 p = inside ? uvec2(at) : uvec2(0);
    uint patchIndex = (p.y >> 4) * patchesAcross() + (p.x >> 4);
    uint used = listed[patchIndex];
    vec4 cell = texelFetch(growth, int(patchIndex * 16u + ((p.y >> 2) & 3u) * 4u + ((p.x >> 2) & 3u)));
    return all(bvec2(inside, used != 0u)) ? cell : vec4(0.0);
}

CellsAround cellsOfSub(ivec2 at) {
    return CellsAround(cellAt(at), cellAt(at - ivec2(4, 0)), cellAt(at - ivec2(0, 4)), cellAt(at - ivec2(4, 4)));
}

vec4 mine[16u * kLayers]; // seen spheres of the sub-patch, then held ones

vec4 boundOfSub(out uint count) {
    count = 0;
    vec3 sum = vec3(0.0);
    [[unroll]] for (uint k = 0; k < 16u * kLayers; ++k) {
        sum += mine[k].w >= 0.0 ? mine[k].xyz : vec3(0.0);
        count += mine[k].w >= 0.0 ? 1u : 0u;
    }
    vec3 centre = count != 0 ? sum / float(count) : vec3(0.0);
    float radius = -1.0;
    [[unroll]] for (uint k = 0; k < 16u * kLayers; ++k) {
        float reach = distance(mine[k].xyz, centre) + mine[k].w;
        radius = mine[k].w >= 0.0 ? max(radius, reach) : radius;
    }
    return outward(centre, radius);
}

void processSubPatch(uint sub) {
    uvec2 corner = pixelOfSlot(sub * 16u);
    CellsAround around = CellsAround(vec4(0.0), vec4(0.0), vec4(0.0), vec4(0.0));
    if (kThin != 0) {
        around = cellsOfSub(ivec2(corner));
    }
    Notes notes = Notes(0, 0, uvec4(0));
    uvec4 rows = rowsOfMasks(sub);
    [[unroll]] for (uint p = 0; p < 16u; ++p) {
        uint mask = maskInRow(rows[p >> 2], p & 3u) & forbiddenMask();
        PixelResult r = handlePixel(sub, p, corner, mask, around, kHold == kHoldWithPoints);
        mine[p] = r.sphere;
        if (kHold != 0) {
            mine[16u * (kLayers - 1u) + p] = r.held;
        }
        notes = noted(notes, p, r.note);
    }
    [[unroll]] for (uint k = 0; k < 4u; ++k) {
        const uint a = 4u * k, b = 16u * (kLayers - 1u) + a;
        putRadii(sub, k, vec4(mine[a].w, mine[a + 1u].w, mine[a + 2u].w, mine[a + 3u].w),
                 vec4(mine[b].w, mine[b + 1u].w, mine[b + 2u].w, mine[b + 3u].w));
    }
    uint count;
    vec4 bound = boundOfSub(count);
    putBound(sub, bound, count, notes);
    classes[sub] = notes.classes;
    for (uint c = 0; kTree != 0 && c < kClasses; ++c) {
        uint largest = 0;
        [[unroll]] for (uint k = 0; k < 16u * kLayers; ++k) {
            largest = max(largest, classIn(notes, k & 15u, k >> 4) == c ? radiusBits(mine[k]) : 0u);
        }
        noteLargest(c, largest);
    }
    if (count != 0) {
        atomicAdd(counters.subs, 1u);
    }
    if (kHold != 0 && notes.remembered != 0) {
        atomicAdd(memoryCounts[sub >> 4], notes.remembered); // zeroed before this pass
    }
}

// Number of listed patches that this dispatch handles.
uint patchesOfPart() {
    return kHold == kHoldNone ? counters.patchGroups.x : (kHold == kHoldWithoutPoints ? counters.withoutHeldGroups.w : counters.withHeldGroups.w);
}

uint patchOfPart(uint i) {
    uint patches = patchCount();
    return list[kHold == kHoldNone ? i : (kHold == kHoldWithoutPoints ? 2u * patches + i : 3u * patches - 1u - i)];
}

void main() {
    if (gl_GlobalInvocationID.x < patchesOfPart() * 16u) {
        processSubPatch(patchOfPart(gl_GlobalInvocationID.x >> 4) * 16u + (gl_GlobalInvocationID.x & 15u));
    }
}
