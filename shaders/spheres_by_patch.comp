#version 460
// SPDX-License-Identifier: Apache-2.0
// Region spheres on GPUs: one group per listed patch; one invocation per pixel, then one per sub-patch. The
// group decides thinning in shared memory. With kPack it also packs its spheres for the host into a run
// ordered by layer (seen, held), then slot. A bit mask marks the occupied slots, so few other bytes cross the
// bus.
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
#include "shaders/shared/constants.h"
#include "shaders/shared/frame_params.h"

layout(constant_id = kSpecHold) const uint kHold = 1;
// 1: the host reads packed runs; 0: points and radii.
layout(constant_id = kSpecPack) const uint kPack = 0;

#include "shaders/lib/spheres.glsl"
#include "shaders/lib/thin_point.glsl"

// Runs; packing.glsl has the format.
layout(std430, binding = 19) writeonly buffer Packed { uint packedWords[]; };
// 16 words per listed patch: bit (layer * 256 + slot in the patch) = packed.
layout(std430, binding = 20) writeonly buffer Places { uint places[]; };
// Listed patch -> x: first word of its run; y: number of spheres + 65536 x class bits, kRunGrown, kRunWide.
layout(std430, binding = 21) writeonly buffer Runs { uvec2 runs[]; };
// sub-patch -> growth, as thin.comp writes it; for verification only.
layout(std430, binding = 22) writeonly buffer Cells { vec4 growth[]; };

vec4 seenAt(uint slot) {
    return seen[slot];
}

vec4 keptAt(uint slot) {
    return kept[slot];
}

uint keptTimeAt(uint slot) {
    return keptTime[slot];
}

// Seen spheres of the patch, then held ones; until thinning is decided, the points that it reads.
shared vec4 patchSpheres[kThin != 0 && kHold == 0 ? 441u : 256u * kLayers];
shared uint patchNotes[256];                       // PixelResult::note of each pixel
const bool kByDepth = kPack != 0 && kBeam == 0;     // seen spheres are packed as depths
shared float patchDepths[kByDepth ? 256 : 1];
shared uint rememberedOfPatch;                     // same encoding as `memoryCounts`
shared uint largestOfPatch[kTree != 0 ? kMaxClasses : 1u]; // as FrameCounters::largestRadius
shared vec4 sumOfColumn[kTree != 0 ? 64 : 1]; // per column: sum of the centres, w = their number
shared vec4 nodeOfSub[kTree != 0 ? 16 : 1];      // as Nodes
shared vec4 centreOfPatch;                       // w = number of spheres (integer bits)
shared uint reachOfPatch;                        // float bits
shared uint countOfSub[kTree != 0 ? 16 : 1];     // as NodeCounts
// Largest distance from the mean to a sphere's far side; < 0 = no sphere.
shared float reachOfColumn[kTree != 0 ? 64 : 1];
#include "shaders/lib/thin_patch.glsl"
#include "shaders/lib/packing.glsl"

// The tree's bounds are computed by four lanes per sub-patch: lane q takes column q % 4 of sub-patch q / 4.
uint placeOf(uint q, uint k) {
    return (k >> 2) * 256u + (q >> 2) * 16u + (k & 3u) * 4u + (q & 3u);
}

void sumColumn(uint q) {
    vec4 sum = vec4(0.0);
    [[unroll]] for (uint k = 0; k < 4u * kLayers; ++k) {
        vec4 sphere = patchSpheres[placeOf(q, k)];
        sum += sphere.w >= 0.0 ? vec4(sphere.xyz, 1.0) : vec4(0.0);
        uint note = patchNotes[placeOf(q, k) & 255u], c = note >> (k < 4u ? 8 : 12) & 15u, bits = radiusBits(sphere);
        if (bits > largestOfPatch[c]) {
            atomicMax(largestOfPatch[c], bits);
        }
    }
    sumOfColumn[q] = sum;
}

// Mean of the sub-patch's centres, and their number.
vec4 centreOf(uint s) {
    vec4 sum = vec4(0.0);
    [[unroll]] for (uint q = 4u * s; q < 4u * s + 4u; ++q) {
        sum += sumOfColumn[q];
    }
    return sum.w != 0.0 ? vec4(sum.xyz / sum.w, sum.w) : vec4(0.0);
}

void reachColumn(uint q) {
    vec3 centre = centreOf(q >> 2).xyz;
    float radius = -1.0;
    [[unroll]] for (uint k = 0; k < 4u * kLayers; ++k) {
        vec4 sphere = patchSpheres[placeOf(q, k)];
        radius = sphere.w >= 0.0 ? max(radius, distance(sphere.xyz, centre) + sphere.w) : radius;
    }
    reachOfColumn[q] = radius;
}

// Called by the whole group after a barrier; ends with one.
void prepareBounds() {
    for (uint q = gl_LocalInvocationID.x; q < 64u; q += gl_WorkGroupSize.x) {
        sumColumn(q);
    }
    barrier();
    for (uint q = gl_LocalInvocationID.x; q < 64u; q += gl_WorkGroupSize.x) {
        reachColumn(q);
    }
    barrier();
}

void boundOfGroup(uint patchIndex, uint s) {
    for (uint k = 0; k < 4u; ++k) {
        uint a = s * 16u + 4u * k, b = 256u * (kLayers - 1u) + a;
        putRadii(patchIndex * 16u + s, k, vec4(patchSpheres[a].w, patchSpheres[a + 1u].w, patchSpheres[a + 2u].w, patchSpheres[a + 3u].w),
                 vec4(patchSpheres[b].w, patchSpheres[b + 1u].w, patchSpheres[b + 2u].w, patchSpheres[b + 3u].w));
    }
    Notes notes = Notes(0, 0, uvec4(0));
    [[unroll]] for (uint p = 0; p < 16u; ++p) {
        notes = noted(notes, p, patchNotes[s * 16u + p]);
    }
    vec4 centre = vec4(0.0);
    float radius = -1.0;
    if (kTree != 0) {
        centre = centreOf(s);
        radius = max(max(reachOfColumn[4u * s], reachOfColumn[4u * s + 1u]), max(reachOfColumn[4u * s + 2u], reachOfColumn[4u * s + 3u]));
    }
    vec4 bound = outward(centre.xyz, radius);
    putBound(patchIndex * 16u + s, bound, uint(centre.w), notes);
    if (kTree != 0) {
        nodeOfSub[s] = bound;
        countOfSub[s] = uint(centre.w);
    }
    // With one class, the run itself names it.
    if (kPack == 0 || (kClasses > 1 && bitCount(classesOfPatch & 0xffu) > 1)) {
        classes[patchIndex * 16u + s] = notes.classes;
    }
    if (kHold != 0 && notes.remembered != 0) {
        atomicAdd(rememberedOfPatch, notes.remembered);
    }
}

// Mean of the patch's centres, and their number. A loop, because registers for 16 nodes would let fewer
// groups run at a time.
vec4 centreOfSubs() {
    vec3 sum = vec3(0.0);
    uint count = 0;
    [[dont_unroll]] for (uint s = 0; s < 16u; ++s) {
        sum += nodeOfSub[s].xyz * float(countOfSub[s]);
        count += countOfSub[s];
    }
    return count != 0 ? vec4(sum / float(count), uintBitsToFloat(count)) : vec4(0.0);
}

// Bound of the patch's sub-patches. Called by the whole group after a barrier.
void boundOfPatch(uint patchIndex) {
    for (uint s = gl_LocalInvocationID.x; s < 16u; s += gl_WorkGroupSize.x) {
        vec4 centre = centreOfSubs();
        if (countOfSub[s] != 0) {
            atomicMax(reachOfPatch, floatBitsToUint(distance(nodeOfSub[s].xyz, centre.xyz) + nodeOfSub[s].w));
        }
        if (s == 0) {
            centreOfPatch = centre;
        }
    }
    barrier();
    if (gl_LocalInvocationID.x == 0) {
        uint node = patchCount() * 16u + patchIndex, count = floatBitsToUint(centreOfPatch.w);
        nodes[node] = outward(centreOfPatch.xyz, count != 0 ? uintBitsToFloat(reachOfPatch) : -1.0);
        nodeCounts[node] = count;
    }
}

void prepareGroup(uint patchIndex, ivec2 patchAt) {
    for (uint w = gl_LocalInvocationID.x; w < 16u; w += gl_WorkGroupSize.x) {
        present[w] = 0;
    }
    if (gl_LocalInvocationID.x == 0) {
        rememberedOfPatch = 0;
        classesOfPatch = 0;
        wideOfPatch = 0;
        reachOfPatch = 0;
    }
    for (uint c = gl_LocalInvocationID.x; kTree != 0 && c < kClasses; c += gl_WorkGroupSize.x) {
        largestOfPatch[c] = 0;
    }
    if (kThin != 0) {
        decideCells(patchIndex, patchAt); // ends with a barrier
    } else {
        barrier();
    }
}

void handlePixels(uint patchIndex, uvec2 patchAt, bool holding) {
    for (uint i = gl_LocalInvocationID.x; i < 256u; i += gl_WorkGroupSize.x) {
        CellsAround around = CellsAround(vec4(0.0), vec4(0.0), vec4(0.0), vec4(0.0));
        if (kThin != 0) {
            around = cellsOfGroup(i >> 4);
        }
        uint sub = patchIndex * 16u + (i >> 4);
        PixelResult r = handlePixel(sub, i & 15u, patchAt + pixelInPatch(i & 240u), maskAt(sub * 16u + (i & 15u)) & forbiddenMask(), around, holding);
        patchSpheres[i] = r.sphere;
        if (kByDepth) {
            patchDepths[i] = r.z;
        }
        markPresent(i, r.sphere.w);
        markClass(1u << (r.note >> 8 & 15u) | (r.note >> 16 != 0 ? kGrownHere : 0u), r.sphere.w);
        if (kHold != 0) {
            patchSpheres[256u * (kLayers - 1u) + i] = r.held;
            markPresent(256u * (kLayers - 1u) + i, r.held.w);
            markClass(1u << (r.note >> 12 & 15u), r.held.w);
        }
        patchNotes[i] = r.note;
    }
}

void processPatch(uint patchIndex) {
    uvec2 patchAt = uvec2(patchIndex % patchesAcross(), patchIndex / patchesAcross()) * 16u;
    bool holding = (listed[patchIndex] & kPatchHolding) != 0;
    prepareGroup(patchIndex, ivec2(patchAt));
    handlePixels(patchIndex, patchAt, holding);
    barrier();
    if (gl_LocalInvocationID.x == gl_WorkGroupSize.x - 1u) {
        countSubs();
        placeRun();
    }
    if (kTree != 0) {
        prepareBounds();
    }
    for (uint s = gl_LocalInvocationID.x; s < 16u; s += gl_WorkGroupSize.x) {
        boundOfGroup(patchIndex, s);
    }
    if (kPack != 0 || kHold != 0 || kTree != 0) {
        barrier();
    }
    for (uint c = gl_LocalInvocationID.x; kTree != 0 && c < kClasses; c += gl_WorkGroupSize.x) {
        noteLargest(c, largestOfPatch[c]);
    }
    if (kTree != 0) {
        boundOfPatch(patchIndex);
    }
    if (kPack != 0) {
        packPatch(patchIndex);
    }
    // Unlisted patches have no memory before or after the frame, so every entry of `memoryCounts` is valid.
    if (kHold != 0 && gl_LocalInvocationID.x == 0) {
        memoryCounts[patchIndex] = rememberedOfPatch;
    }
}

void main() {
    processPatch(list[gl_WorkGroupID.x]);
}
