#version 460
// SPDX-License-Identifier: Apache-2.0
// Region spheres of the listed patches and the bounds of their 4x4 sub-patches (paper IV.B.1, eq. 3). One invocation
// a sub-patch, or (kByPixel) one group a patch: one invocation a pixel, then one a sub-patch. With hold, points of earlier frames that the new picture does not contradict stay as a second layer.
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/frame_params.h"

layout(local_size_x_id = 0) in; // divides 256
layout(constant_id = 1) const uint kThin = 1;       // 1: the error budget leaves points out
layout(constant_id = 2) const uint kHold = 1;       // 1: unseen points stay for a while
layout(constant_id = 3) const uint kByPixel = 0;    // 1: a group a patch; the group size divides 256
layout(constant_id = 4) const uint kLeaks = 1;      // 1: within near..far neighbours may be a radius apart

layout(std140, binding = 0) uniform Params { FrameParams params; };
layout(std430, binding = 1) readonly buffer Depth { uint depthWords[]; };
layout(std430, binding = 2) readonly buffer Masks { uint masks[]; };
layout(std430, binding = 3) readonly buffer Points { vec4 points[]; };
layout(std430, binding = 4) readonly buffer Listed { uint listed[]; };
layout(std430, binding = 5) readonly buffer List { uint list[]; };
layout(std430, binding = 6) readonly buffer Cells { vec4 growth[]; };
layout(std430, binding = 7) buffer Counters { FrameCounters counters; };
layout(std430, binding = 8) buffer Seen { vec4 seen[]; };          // slot -> last frame's point, w = bits of class + 1
layout(std430, binding = 9) buffer Kept { vec4 kept[]; };          // slot -> held point, w = bits of class + 1
layout(std430, binding = 10) buffer KeptTime { uint keptTime[]; }; // slot -> when it was seen last [us]
layout(std430, binding = 11) buffer Live { uint live[]; };         // patch -> points in memory
layout(std430, binding = 12) writeonly buffer Spheres { vec4 spheres[]; };      // slot -> centre, R; R < 0 = none
layout(std430, binding = 13) writeonly buffer Held { vec4 held[]; };            // the same for held points
layout(std430, binding = 14) writeonly buffer Classes { uint classes[]; };      // slot -> class of the sphere | class of the held one << 8
layout(std430, binding = 15) writeonly buffer Bits { uint bits[]; };            // sub-patch -> 16 pixels, 1 = forbidden class
layout(std430, binding = 16) writeonly buffer Nodes { vec4 nodes[]; };
layout(std430, binding = 17) writeonly buffer NodeCounts { uint nodeCounts[]; };

const uint kRays = 0; // this pass needs no rays
const vec2 rays[1] = vec2[1](vec2(0.0));
#include "shaders/lib/depth.glsl"
#include "shaders/lib/forbidden.glsl"
#include "shaders/lib/lens.glsl"
#include "shaders/lib/hold.glsl"
#include "shaders/lib/slots.glsl"
#include "shaders/lib/thinning.glsl"

// Warns of holes: neighbours of one class on one surface that are at least R apart.
void noteLeak(uvec2 at, uvec2 next, vec4 p, uint c) {
    if (any(greaterThanEqual(next, params.size.xy)) || listed[(next.y >> 4) * params.size.z + (next.x >> 4)] == 0) {
        return;
    }
    uint slot = slotOfPixel(next, params.size.z);
    vec4 q = points[slot];
    float apart = distance(p.xyz, q.xyz);
    bool surface = abs(q.w - p.w) <= 0.7 * apart; // steeper than 45 degrees is rather an edge
    if (q.w != 0.0 && apart >= params.classes[c].role.x && surface && forbiddenAt(slot) == c) {
        atomicMax(counters.leakSpacing[c], floatBitsToUint(apart));
        atomicMax(counters.leakRange[c], floatBitsToUint(p.w));
    }
}

const uint kLayers = kHold != 0 ? 2u : 1u;
// By pixel, a group shares the thinning of the patch's 4x4 cells and of those left of and above it, 5 a row; spheres of the
// patch, then held ones; and notes as in PixelResult.
shared vec4 cells[kByPixel != 0 && kThin != 0 ? 25 : 1];
shared vec4 all[kByPixel != 0 ? 256 * kLayers : 1];
shared uint noted[kByPixel != 0 ? 256 : 1];

CellsAround cellsOfGroup(uint sub) {
    uint at = (sub >> 2) * 5u + (sub & 3u); // of the corner cell
    return CellsAround(cells[at + 6u], cells[at + 5u], cells[at + 1u], cells[at]);
}

CellsAround cellsOfSub(ivec2 at) {
    return CellsAround(cellAt(at), cellAt(at - ivec2(4, 0)), cellAt(at - ivec2(0, 4)), cellAt(at - ivec2(4, 4)));
}

// The sphere of the point seen now in a slot; R < 0 when there is none or the budget leaves it out.
vec4 seenSphere(uint slot, uvec2 at, uint c, CellsAround around) {
    if (c == kNone) {
        return vec4(0.0, 0.0, 0.0, -1.0);
    }
    vec4 p = points[slot];
    if (kLeaks != 0) {
        noteLeak(at, at + uvec2(1, 0), p, c);
        noteLeak(at, at + uvec2(0, 1), p, c);
    }
    float grown = kThin != 0 ? keptGrowth(at, around) : 0.0;
    return vec4(p.xyz, grown < 0.0 ? -1.0 : params.classes[c].role.x + grown);
}

struct PixelResult {
    vec4 sphere, held; // R < 0 = none
    uint note;         // 1 = a forbidden class; 2 x points remembered
};

PixelResult handlePixel(uint slot, uvec2 at, CellsAround around) {
    uint c = forbiddenAt(slot), remembered = 0, heldClass = 0;
    uint note = (masks[slot] & params.depthBand.w) != 0 ? 1u : 0u;
    vec4 sphere = seenSphere(slot, at, c, around), heldSphere = vec4(0.0, 0.0, 0.0, -1.0);
    if (kHold != 0) {
        heldSphere = updateMemory(slot, c, heldClass, remembered);
    }
    spheres[slot] = sphere;
    if (kHold != 0) {
        held[slot] = heldSphere;
    }
    classes[slot] = (c == kNone ? 0u : c) | heldClass << 8;
    return PixelResult(sphere, heldSphere, note + 2u * remembered);
}

// Paper eq. 3: centre = mean, radius = max(|s_k - centre| + r_k), rounded outward. Sums in fixed order.
void putBound(uint sub, vec3 centre, float radius, uint count, uint marks, uint remembered) {
    bits[sub] = marks;
    nodes[sub] = vec4(centre, radius >= 0.0 ? radius * 1.000001 + 1e-7 : -1.0);
    nodeCounts[sub] = count;
    if (count != 0) {
        atomicAdd(counters.nodes, 1u);
    }
    if (kHold != 0 && remembered != 0) {
        atomicAdd(live[sub >> 4], remembered);
    }
}

void wholeSub(uint sub) {
    vec4 mine[16u * kLayers];
    uvec2 corner = pixelOfSlot(sub * 16u, params.size.z);
    CellsAround around = CellsAround(vec4(0.0), vec4(0.0), vec4(0.0), vec4(0.0));
    if (kThin != 0) {
        around = cellsOfSub(ivec2(corner));
    }
    uint count = 0, marks = 0, remembered = 0;
    for (uint p = 0; p < 16u; ++p) {
        PixelResult r = handlePixel(sub * 16u + p, corner + uvec2(p & 3u, p >> 2), around);
        mine[p] = r.sphere;
        mine[16u * (kLayers - 1u) + p] = kHold != 0 ? r.held : r.sphere;
        marks |= (r.note & 1u) << p;
        remembered += r.note >> 1;
    }
    vec3 sum = vec3(0.0);
    for (uint k = 0; k < 16u * kLayers; ++k) {
        sum += mine[k].w >= 0.0 ? mine[k].xyz : vec3(0.0);
        count += mine[k].w >= 0.0 ? 1u : 0u;
    }
    vec3 centre = count != 0 ? sum / float(count) : vec3(0.0);
    float radius = -1.0;
    for (uint k = 0; k < 16u * kLayers; ++k) {
        radius = mine[k].w >= 0.0 ? max(radius, distance(mine[k].xyz, centre) + mine[k].w) : radius;
    }
    putBound(sub, centre, radius, count, marks, remembered);
}

// The same from what the group shares.
void boundOfGroup(uint patchIndex, uint s) {
    vec3 sum = vec3(0.0);
    uint count = 0, marks = 0, remembered = 0;
    for (uint k = 0; k < 16u * kLayers; ++k) {
        vec4 sphere = all[(k >> 4) * 256u + s * 16u + (k & 15u)];
        sum += sphere.w >= 0.0 ? sphere.xyz : vec3(0.0);
        count += sphere.w >= 0.0 ? 1u : 0u;
    }
    vec3 centre = count != 0 ? sum / float(count) : vec3(0.0);
    float radius = -1.0;
    for (uint k = 0; k < 16u * kLayers; ++k) {
        vec4 sphere = all[(k >> 4) * 256u + s * 16u + (k & 15u)];
        radius = sphere.w >= 0.0 ? max(radius, distance(sphere.xyz, centre) + sphere.w) : radius;
    }
    for (uint p = 0; p < 16u; ++p) {
        marks |= (noted[s * 16u + p] & 1u) << p;
        remembered += noted[s * 16u + p] >> 1;
    }
    putBound(patchIndex * 16u + s, centre, radius, count, marks, remembered);
}

void wholePatch(uint patchIndex) {
    uvec2 patchAt = uvec2(patchIndex % params.size.z, patchIndex / params.size.z) * 16u;
    if (kThin != 0) {
        for (uint i = gl_LocalInvocationID.x; i < 25u; i += gl_WorkGroupSize.x) {
            cells[i] = cellAt(ivec2(patchAt) + 4 * ivec2(int(i % 5u) - 1, int(i / 5u) - 1));
        }
        barrier();
    }
    for (uint i = gl_LocalInvocationID.x; i < 256u; i += gl_WorkGroupSize.x) {
        CellsAround around = CellsAround(vec4(0.0), vec4(0.0), vec4(0.0), vec4(0.0));
        if (kThin != 0) {
            around = cellsOfGroup(i >> 4);
        }
        PixelResult r = handlePixel(patchIndex * 256u + i, patchAt + pixelInPatch(i), around);
        all[i] = r.sphere;
        if (kHold != 0) {
            all[256u * (kLayers - 1u) + i] = r.held;
        }
        noted[i] = r.note;
    }
    barrier();
    for (uint s = gl_LocalInvocationID.x; s < 16u; s += gl_WorkGroupSize.x) {
        boundOfGroup(patchIndex, s);
    }
}

void main() {
    if (kByPixel != 0) {
        wholePatch(list[gl_WorkGroupID.x]);
    } else if (gl_GlobalInvocationID.x < counters.patchGroups.x * 16u) {
        wholeSub(list[gl_GlobalInvocationID.x >> 4] * 16u + (gl_GlobalInvocationID.x & 15u));
    }
}
