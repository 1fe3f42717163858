#version 460
// SPDX-License-Identifier: Apache-2.0
// Region spheres of the listed patches and the bounds of their 4x4 sub-patches (paper IV.B.1, eq. 3). One invocation a
// sub-patch. With hold, points of earlier frames that the new picture does not contradict stay as a second layer.
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/frame_params.h"

layout(local_size_x_id = 0) in;
layout(constant_id = 1) const uint kThin = 1;       // 1: the error budget leaves points out
layout(constant_id = 2) const uint kHold = 1;       // 1: unseen points stay for a while
layout(constant_id = 3) const uint kDeviceCopy = 0; // 1: the GPU query reads its own copy

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
layout(std430, binding = 18) writeonly buffer DeviceSpheres { vec4 deviceSpheres[]; };
layout(std430, binding = 19) writeonly buffer DeviceHeld { vec4 deviceHeld[]; };

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

// The sphere of the point seen now in a slot; R < 0 when there is none or the budget leaves it out.
vec4 seenSphere(uint slot, uvec2 at, uint c) {
    if (c == kNone) {
        return vec4(0.0, 0.0, 0.0, -1.0);
    }
    vec4 p = points[slot];
    noteLeak(at, at + uvec2(1, 0), p, c);
    noteLeak(at, at + uvec2(0, 1), p, c);
    float grown = kThin != 0 ? keptGrowth(at) : 0.0;
    return vec4(p.xyz, grown < 0.0 ? -1.0 : params.classes[c].role.x + grown);
}

const uint kAll = kHold != 0 ? 32u : 16u; // layers x pixels of a sub-patch

void main() {
    uint index = gl_GlobalInvocationID.x;
    if (index >= counters.patchGroups.x * 16u) {
        return;
    }
    uint patchIndex = list[index >> 4];
    uint sub = patchIndex * 16u + (index & 15u);
    vec3 sum = vec3(0.0);
    uint count = 0, marks = 0, remembered = 0;
    vec4 all[kAll];
    for (uint p = 0; p < 16u; ++p) {
        uint slot = sub * 16u + p;
        uvec2 at = pixelOfSlot(slot, params.size.z);
        uint c = forbiddenAt(slot);
        marks |= (masks[slot] & params.depthBand.w) != 0 ? 1u << p : 0u;
        vec4 sphere = seenSphere(slot, at, c);
        spheres[slot] = sphere;
        uint both = c == kNone ? 0u : c;
        all[p] = sphere;
        if (kHold != 0) {
            uint heldClass = 0;
            vec4 heldSphere = updateMemory(slot, c, heldClass, remembered);
            held[slot] = heldSphere;
            both |= heldClass << 8;
            all[16u + p] = heldSphere;
            if (kDeviceCopy != 0) {
                deviceHeld[slot] = heldSphere;
            }
        }
        if (kDeviceCopy != 0) {
            deviceSpheres[slot] = sphere;
        }
        classes[slot] = both;
    }
    for (uint p = 0; p < kAll; ++p) {
        sum += all[p].w >= 0.0 ? all[p].xyz : vec3(0.0);
        count += all[p].w >= 0.0 ? 1u : 0u;
    }
    bits[sub] = marks;
    // Paper eq. 3: centre = mean, radius = max(|s_k - centre| + r_k), rounded outward.
    vec3 centre = count != 0 ? sum / float(count) : vec3(0.0);
    float radius = -1.0;
    for (uint p = 0; p < kAll; ++p) {
        radius = all[p].w >= 0.0 ? max(radius, distance(all[p].xyz, centre) + all[p].w) : radius;
    }
    nodes[sub] = vec4(centre, radius >= 0.0 ? radius * 1.000001 + 1e-7 : -1.0);
    nodeCounts[sub] = count;
    if (count != 0) {
        atomicAdd(counters.nodes, 1u);
    }
    if (kHold != 0 && remembered != 0) {
        atomicAdd(live[patchIndex], remembered);
    }
}
