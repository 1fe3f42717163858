#version 460
// SPDX-License-Identifier: Apache-2.0
// Region spheres of the listed patches and the bounds of their 4x4 sub-patches (paper IV.B.1, eq. 3). One invocation
// a sub-patch, or (kByPixel) one group a patch: one invocation a pixel, then one a sub-patch. With hold, points of earlier frames that
// the new picture does not contradict stay as a second layer. A group that has a patch can pack its spheres (kPack) into a run for the
// host, by layer (seen, held), then slot, and say by bits which places these are: what crosses the bus is little more than the spheres.
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
#include "shaders/shared/frame_params.h"

layout(local_size_x_id = 0) in; // divides 256
layout(constant_id = 1) const uint kThin = 1;       // 1: the error budget leaves points out, as thin.comp decided or (kByPixel) as is decided here
layout(constant_id = 2) const uint kHold = 1;       // unseen points stay for a while: 1 in patches that hold nothing yet, 2 in those that do,
                                                    // 3 (with kByPixel) in all
layout(constant_id = 3) const uint kByPixel = 0;    // 1: a group a patch; the group size divides 256
layout(constant_id = 4) const uint kLeaks = 1;      // 1: within near..far neighbours may be a radius apart
layout(constant_id = 5) const uint kClasses = 1;    // classes of points
layout(constant_id = 6) const uint kFan = 0;        // 1: pixels are beams at equal angles
layout(constant_id = 7) const uint kBeam = 0;       // 1: spheres grow by 3 sigma of their points
layout(constant_id = 8) const uint kTree = 1;       // 1: a query asks for bounds and slots
layout(constant_id = 9) const uint kPack = 0;       // 1 (with kByPixel): the host reads runs; 0: it reads radii beside points
layout(constant_id = 10) const uint kTexels = 1;    // 1: memory of points is read as texels. A compiler may take these for memory that
                                                    // nobody writes and fetch late: an H100 then read what it had just written

layout(std140, binding = 0) uniform Params { FrameParams params; };
layout(binding = 1) uniform usamplerBuffer depths; // uint16 a pixel
layout(binding = 2) uniform usamplerBuffer masks; // a byte a slot: class bits
layout(binding = 3) uniform samplerBuffer points; // a slot: base point about the origin, w = z [m]; 0 = none
layout(std430, binding = 4) readonly buffer Listed { uint listed[]; };
layout(std430, binding = 5) readonly buffer List { uint list[]; }; // its parts: frame_params.h
layout(binding = 6) uniform samplerBuffer growth; // a sub-patch, without kByPixel: what thin.comp decided
layout(std430, binding = 7) buffer Counters { FrameCounters counters; };
layout(std430, binding = 8) buffer Seen { vec4 seen[]; };          // slot -> last frame's point, w = bits of class + 1
layout(std430, binding = 9) buffer Kept { vec4 kept[]; };          // slot -> held point, w = bits of class + 1
layout(std430, binding = 10) buffer KeptTime { uint keptTime[]; }; // slot -> when it was seen last [us]
layout(std430, binding = 11) buffer Live { uint live[]; };         // patch -> points in memory + 65536 x held ones among them
layout(std430, binding = 12) writeonly buffer Spheres { vec4 spheres[]; };      // slot -> centre, R; R < 0 = none
layout(std430, binding = 13) writeonly buffer Held { vec4 held[]; };            // the same for held points
layout(std430, binding = 14) writeonly buffer Classes { uvec4 classes[]; };     // a byte a slot: class of the sphere | class of the held one << 4
layout(std430, binding = 15) writeonly buffer Bits { uint bits[]; };            // sub-patch -> 16 pixels, 1 = forbidden class
layout(std430, binding = 16) writeonly buffer Nodes { vec4 nodes[]; };
layout(std430, binding = 17) writeonly buffer NodeCounts { uint nodeCounts[]; };
layout(std430, binding = 21) writeonly buffer Packed { uint packedWords[]; }; // runs: packing.glsl
layout(std430, binding = 22) writeonly buffer Places { uint places[]; }; // 16 words a listed patch: bit (layer * 256 + slot in the patch) = packed
layout(std430, binding = 23) writeonly buffer Runs { uvec2 runs[]; };    // listed patch -> its first word; how many spheres + 65536 x bits of their classes, kRunGrown, kRunWide
layout(std430, binding = 24) writeonly buffer Radii { vec4 radii[]; };          // a row of a sub-patch: R of its four points, < 0 = none
layout(std430, binding = 25) writeonly buffer HeldRadii { vec4 heldRadii[]; };  // the same for held points, which lie in `kept`
layout(std430, binding = 26) writeonly buffer Decided { vec4 decided[]; };      // a sub-patch, with kByPixel: `growth` as thin.comp writes it, for those who verify
// Seen, kept and when, to read (kTexels): an invocation reads a slot before it writes it, and no other does either.
layout(binding = 18) uniform samplerBuffer seenBefore;
layout(binding = 19) uniform samplerBuffer keptBefore;
layout(binding = 20) uniform usamplerBuffer keptTimeBefore;

const uint kRays = 0; // this pass needs no rays
const vec2 rays[1] = vec2[1](vec2(0.0));
#include "shaders/lib/beam.glsl"
#include "shaders/lib/depth.glsl"
#include "shaders/lib/masks.glsl"
#include "shaders/lib/forbidden.glsl"
#include "shaders/lib/lens.glsl"
#include "shaders/lib/hold.glsl"
#include "shaders/lib/slots.glsl"
#include "shaders/lib/leaks.glsl"
#include "shaders/lib/thinning.glsl"
#include "shaders/lib/thin_point.glsl"
#include "shaders/lib/seen_sphere.glsl"

const uint kLayers = kHold != 0 ? 2u : 1u;

CellsAround cellsOfSub(ivec2 at) {
    return CellsAround(cellAt(at), cellAt(at - ivec2(4, 0)), cellAt(at - ivec2(0, 4)), cellAt(at - ivec2(4, 4)));
}

struct PixelResult {
    vec4 sphere, held; // R < 0 = none
    float z;           // of the point that is seen [m]
    uint note;         // 1 = a forbidden class; 2 = it is remembered; 4 = the held one is; 256 x class of the sphere; 4096 x class of the held one;
                       // 65536 x steps that the sphere grows by
};

// Pixel p (0..15) of the sub-patch `sub`, whose corner lies at `corner`. holding: its patch holds points (kHold = 3).
PixelResult handlePixel(uint sub, const uint p, uvec2 corner, uint mask, CellsAround around, bool holding) {
    uint slot = sub * 16u + p, remembered = 0, heldClass = 0;
    vec4 point = texelFetch(points, int(slot));
    uint c = forbiddenClass(point.w != 0.0 ? mask : 0u);
    float more = grownBySigma(point.xyz);
    float grown = kThin != 0 ? keptGrowth(p, around) : 0.0;
    vec4 sphere = seenSphere(point, c, grown, more), heldSphere = vec4(0.0, 0.0, 0.0, -1.0);
    if (kLeaks != 0 && c != kNone) {
        uvec2 at = corner + uvec2(p & 3u, p >> 2);
        noteLeak(at + uvec2(1, 0), point, c);
        noteLeak(at + uvec2(0, 1), point, c);
    }
    if (kHold != 0) {
        heldSphere = updateMemory(slot, point.xyz, c, more, holding, heldClass, remembered);
    }
    if (kTree != 0) {
        spheres[slot] = sphere;
        if (kHold != 0) {
            held[slot] = heldSphere;
        }
    }
    uint classBits = (c == kNone ? 0u : c) | heldClass << 4;
    return PixelResult(sphere, heldSphere, point.w, (mask != 0u ? 1u : 0u) | remembered << 1 | classBits << 8 | stepsOf(grown) << 16);
}

// What the pixels of a sub-patch say together.
struct Notes {
    uint marks, remembered; // a bit a pixel of a forbidden class; points as in `live`
    uvec4 classes;          // a byte a pixel
};

Notes noted(Notes n, const uint p, uint note) {
    n.marks |= (note & 1u) << p;
    n.remembered += (note >> 1 & 1u) + (note >> 2 & 1u) * 65537u;
    n.classes[p >> 2] |= (note >> 8 & 255u) << ((p & 3u) * 8u);
    return n;
}

// Paper eq. 3: centre = mean, radius = max(|s_k - centre| + r_k), rounded outward. Sums in fixed order.
void putBound(uint sub, vec3 centre, float radius, uint count, Notes notes) {
    bits[sub] = notes.marks;
    if (kTree != 0) {
        nodes[sub] = vec4(centre, radius >= 0.0 ? radius * 1.000001 + 1e-7 : -1.0);
        nodeCounts[sub] = count;
    }
}

// Of row k of a sub-patch: seen points and held ones.
void putRadii(uint sub, uint k, vec4 seenHere, vec4 heldHere) {
    if (kPack == 0) {
        radii[sub * 4u + k] = seenHere;
        if (kHold != 0) {
            heldRadii[sub * 4u + k] = heldHere;
        }
    }
}

void wholeSub(uint sub) {
    vec4 mine[16u * kLayers];
    uvec2 corner = pixelOfSlot(sub * 16u, params.size.z);
    CellsAround around = CellsAround(vec4(0.0), vec4(0.0), vec4(0.0), vec4(0.0));
    if (kThin != 0) {
        around = cellsOfSub(ivec2(corner));
    }
    Notes notes = Notes(0, 0, uvec4(0));
    uint count = 0;
    uvec4 rows = rowsOfMasks(sub);
    [[unroll]] for (uint p = 0; p < 16u; ++p) {
        uint mask = maskInRow(rows[p >> 2], p & 3u) & params.depthBand.w;
        PixelResult r = handlePixel(sub, p, corner, mask, around, false);
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
    putBound(sub, centre, radius, count, notes);
    classes[sub] = notes.classes;
    if (count != 0) {
        atomicAdd(counters.nodes, 1u);
    }
    if (kHold != 0 && notes.remembered != 0) {
        atomicAdd(live[sub >> 4], notes.remembered); // zeroed before this pass
    }
}

#include "shaders/lib/patch_group.glsl"

// The listed patches that this dispatch is for.
uint patchesOfPart() {
    return kHold == 0 ? counters.patchGroups.x : (kHold == 1 ? counters.quietGroups.w : counters.holdingGroups.w);
}

uint patchOfPart(uint i) {
    uint patches = params.size.z * params.size.w;
    return list[kHold == 0 ? i : (kHold == 1 ? 2u * patches + i : 3u * patches - 1u - i)];
}

void main() {
    if (kByPixel != 0) {
        wholePatch(list[gl_WorkGroupID.x]);
    } else if (gl_GlobalInvocationID.x < patchesOfPart() * 16u) {
        wholeSub(patchOfPart(gl_GlobalInvocationID.x >> 4) * 16u + (gl_GlobalInvocationID.x & 15u));
    }
}
