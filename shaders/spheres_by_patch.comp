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
layout(constant_id = kSpecPack) const uint kPack = 0; // 1: the host reads packed runs; 0: it reads points and radii

#include "shaders/lib/spheres.glsl"
#include "shaders/lib/thin_point.glsl"

layout(std430, binding = 19) writeonly buffer Packed { uint packedWords[]; }; // runs; packing.glsl has the format
// 16 words per listed patch: bit (layer * 256 + slot in the patch) = packed.
layout(std430, binding = 20) writeonly buffer Places { uint places[]; };
// Listed patch -> x: first word of its run; y: number of spheres + 65536 x class bits, kRunGrown, kRunWide.
layout(std430, binding = 21) writeonly buffer Runs { uvec2 runs[]; };
// sub-patch -> growth, as thin.comp writes it; for verification only.
layout(std430, binding = 22) writeonly buffer Decided { vec4 decided[]; };

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
shared vec4 ofPatch[kThin != 0 && kHold == 0 ? 441u : 256u * kLayers];
shared uint notesOfPatch[256];                     // PixelResult::note of each pixel
const bool kByDepth = kPack != 0 && kBeam == 0;     // seen spheres are packed as depths
shared float zOfPatch[kByDepth ? 256 : 1];
shared uint rememberedOfPatch;                     // same encoding as `live`
shared uint largestOfPatch[kTree != 0 ? kClasses : 1u]; // as FrameCounters::largestRadius
#include "shaders/lib/thin_patch.glsl"
#include "shaders/lib/packing.glsl"

// Of sub-patch s.
void largestOfGroup(uint s, Notes notes) {
    for (uint c = 0; c < kClasses; ++c) {
        uint largest = 0;
        for (uint k = 0; k < 16u * kLayers; ++k) {
            uint bits = radiusBits(ofPatch[(k >> 4) * 256u + s * 16u + (k & 15u)]);
            largest = max(largest, classIn(notes, k & 15u, k >> 4) == c ? bits : 0u);
        }
        if (largest != 0) {
            atomicMax(largestOfPatch[kTree != 0 ? c : 0u], largest);
        }
    }
}

void boundOfGroup(uint patchIndex, uint s) {
    vec3 sum = vec3(0.0);
    uint count = 0;
    for (uint k = 0; k < 16u * kLayers; ++k) {
        vec4 sphere = ofPatch[(k >> 4) * 256u + s * 16u + (k & 15u)];
        sum += sphere.w >= 0.0 ? sphere.xyz : vec3(0.0);
        count += sphere.w >= 0.0 ? 1u : 0u;
    }
    vec3 centre = count != 0 ? sum / float(count) : vec3(0.0);
    float radius = -1.0;
    for (uint k = 0; k < 16u * kLayers; ++k) {
        vec4 sphere = ofPatch[(k >> 4) * 256u + s * 16u + (k & 15u)];
        radius = sphere.w >= 0.0 ? max(radius, distance(sphere.xyz, centre) + sphere.w) : radius;
    }
    for (uint k = 0; k < 4u; ++k) {
        uint a = s * 16u + 4u * k, b = 256u * (kLayers - 1u) + a;
        putRadii(patchIndex * 16u + s, k, vec4(ofPatch[a].w, ofPatch[a + 1u].w, ofPatch[a + 2u].w, ofPatch[a + 3u].w),
                 vec4(ofPatch[b].w, ofPatch[b + 1u].w, ofPatch[b + 2u].w, ofPatch[b + 3u].w));
    }
    Notes notes = Notes(0, 0, uvec4(0));
    [[unroll]] for (uint p = 0; p < 16u; ++p) {
        notes = noted(notes, p, notesOfPatch[s * 16u + p]);
    }
    putBound(patchIndex * 16u + s, centre, radius, count, notes);
    if (kTree != 0) {
        largestOfGroup(s, notes);
    }
    if (kPack == 0 || (kClasses > 1 && bitCount(classesOfPatch & 0xffu) > 1)) { // with one class, the run itself names it
        classes[patchIndex * 16u + s] = notes.classes;
    }
    if (kHold != 0 && notes.remembered != 0) {
        atomicAdd(rememberedOfPatch, notes.remembered);
    }
}

void prepareGroup(uint patchIndex, ivec2 patchAt) {
    for (uint w = gl_LocalInvocationID.x; w < 16u; w += gl_WorkGroupSize.x) {
        present[w] = 0;
    }
    if (gl_LocalInvocationID.x == 0) {
        rememberedOfPatch = 0, classesOfPatch = 0, wideOfPatch = 0;
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

void wholePatch(uint patchIndex) {
    uvec2 patchAt = uvec2(patchIndex % params.size.z, patchIndex / params.size.z) * 16u;
    bool holding = (listed[patchIndex] & kPatchHolding) != 0;
    prepareGroup(patchIndex, ivec2(patchAt));
    for (uint i = gl_LocalInvocationID.x; i < 256u; i += gl_WorkGroupSize.x) {
        CellsAround around = CellsAround(vec4(0.0), vec4(0.0), vec4(0.0), vec4(0.0));
        if (kThin != 0) {
            around = cellsOfGroup(i >> 4);
        }
        uint sub = patchIndex * 16u + (i >> 4);
        PixelResult r = handlePixel(sub, i & 15u, patchAt + pixelInPatch(i & 240u), maskAt(sub * 16u + (i & 15u)) & params.depthBand.w, around, holding);
        ofPatch[i] = r.sphere;
        if (kByDepth) {
            zOfPatch[i] = r.z;
        }
        markPresent(i, r.sphere.w);
        markClass(1u << (r.note >> 8 & 15u) | (r.note >> 16 != 0 ? kGrownHere : 0u), r.sphere.w);
        if (kHold != 0) {
            ofPatch[256u * (kLayers - 1u) + i] = r.held;
            markPresent(256u * (kLayers - 1u) + i, r.held.w);
            markClass(1u << (r.note >> 12 & 15u), r.held.w);
        }
        notesOfPatch[i] = r.note;
    }
    barrier();
    if (gl_LocalInvocationID.x == gl_WorkGroupSize.x - 1u) {
        countSubs();
        placeRun();
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
    if (kPack != 0) {
        packPatch(patchIndex);
    }
    // Unlisted patches have no memory before or after the frame, so every entry of `live` is valid.
    if (kHold != 0 && gl_LocalInvocationID.x == 0) {
        live[patchIndex] = rememberedOfPatch;
    }
}

void main() {
    wholePatch(list[gl_WorkGroupID.x]);
}
