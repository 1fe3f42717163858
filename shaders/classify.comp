#version 460
// SPDX-License-Identifier: Apache-2.0
// Finds the classes of each pixel: depth in near..far, colour gates, and box on the unfiltered point (paper
// IV.B). One invocation per kRows rows of four pixels. The first pixel with a class marks its patch. No
// result depends on the order of invocations.
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
#include "shaders/shared/constants.h"
#include "shaders/shared/frame_params.h"

layout(local_size_x_id = kSpecGroupSize) in;
layout(constant_id = kSpecRays) const uint kRays = 0;
layout(constant_id = kSpecColour) const uint kColour = 1;
layout(constant_id = kSpecHold) const uint kHold = 0;
layout(constant_id = kSpecSubPatchGroup) const uint kSubPatchGroup = 64;
layout(constant_id = kSpecClasses) const uint kClasses = 1;
layout(constant_id = kSpecBox) const uint kBox = 0;
layout(constant_id = kSpecFour) const uint kFour = 0;
layout(constant_id = kSpecRange) const uint kRange = 0;
layout(constant_id = kSpecSelfFilter) const uint kSelfFilter = 0;
layout(constant_id = kSpecWater) const uint kWater = 0;
layout(constant_id = kSpecRows) const uint kRows = 1;
layout(constant_id = kSpecWide) const uint kWide = 0;
layout(constant_id = kSpecKeep) const uint kKeep = 0;
layout(constant_id = kSpecGuidance) const uint kGuidance = 0;
layout(constant_id = kSpecLists) const uint kLists = 0;
layout(constant_id = kSpecFormat) const uint kFormat = 0;

layout(std140, binding = 0) uniform Params { FrameParams params; };
layout(binding = 1) uniform usamplerBuffer depths; // uint16 per pixel; kFour: four per texel
layout(std430, binding = 2) readonly buffer Rays { vec2 rays[]; };
// Texels: one pixel (RGBA) or one pair (YUYV, UYVY) of four bytes; one word for formats of single bytes.
// With kFourDepthAndColour: the words of four pixels, except for formats of single bytes.
layout(binding = 3) uniform usamplerBuffer colours;
layout(std430, binding = 4) readonly buffer Cells { uint nearest[]; };
layout(std430, binding = 5) writeonly buffer Masks { uint masks[]; };       // one byte per slot: class bits
layout(std430, binding = 6) buffer Listed { uint listed[]; };               // patch -> kPatch bits
// Patches in any order; frame_params.h describes its parts.
layout(std430, binding = 7) writeonly buffer List { uint list[]; };
layout(std430, binding = 8) buffer Counters { FrameCounters counters; };
// Patch -> points in memory + 65536 x held points.
layout(std430, binding = 9) readonly buffer Memory { uint memoryCounts[]; };
// Spheres of the arm, relative to the origin [m]. arm[0].x = number of links (integer bits). Each link has
// two entries: its bounding sphere, then begin and end of its spheres (integer bits).
layout(std430, binding = 10) readonly buffer Arm { vec4 arm[]; };
layout(std430, binding = 11) writeonly buffer Depth { uvec2 keptDepth[]; }; // uint16 per pixel, as uploaded

#include "shaders/lib/params.glsl"
#include "shaders/lib/colour.glsl"
#include "shaders/lib/depth.glsl"
#include "shaders/lib/lens.glsl"
#include "shaders/lib/colour_cell.glsl"
#include "shaders/lib/lists.glsl"
#include "shaders/lib/raw_colour.glsl"
#include "shaders/lib/slots.glsl"
#include "shaders/lib/transform.glsl"

// Looks up the colour of a point in the colour image. Returns false when the colour camera does not see the
// point.
bool colourOf(vec3 p, out vec3 rgb) {
    rgb = vec3(0.0);
    vec3 q = transformPoint(params.colourTdepth, p);
    if (q.z <= 0.0) {
        return false;
    }
    ivec2 at = colourPixel(q);
    if (isOutsideColour(at)) {
        return false;
    }
    float front = uintBitsToFloat(nearest[cellOfColour(at)]);
    if (q.z > front * 1.02 + 0.005) {
        return false; // a nearer surface hides it from the colour camera
    }
    rgb = colourAt(uvec2(at));
    return true;
}

// Corrects a colour for attenuation in water (Beer-Lambert). Returns whole bytes, as the gates expect.
vec3 withoutWater(vec3 rgb, vec3 p) {
    return kWater != 0 ? floor(min(rgb * exp(attenuation() * length(p)), vec3(255.0)) + 0.5) : rgb;
}

// Avoids && and ||, which branch.
bool inClass(ClassParams c, Hsl colourHere, bool seen, vec3 base) {
    float inside = kColour != kColourRegistered && !seen ? c.boxMax.w : insideGates(colourHere, c);
    if (kBox != 0) {
        vec3 box = min(base - c.boxMin.xyz, c.boxMax.xyz - base);
        inside = c.boxMin.w == 0.0 ? inside : min(inside, min(box.x, min(box.y, box.z)) >= 0.0 ? 0.0 : -1.0);
    }
    return inside >= -1e-4;
}

bool inRange(vec4 gate, float range) {
    return kRange != 0 ? any(bvec2(gate.z == 0.0, clamp(range, gate.x, gate.y) == range)) : true;
}

bool within(vec3 p, vec4 sphere) {
    vec3 d = p - sphere.xyz;
    return dot(d, d) <= sphere.w * sphere.w;
}

bool onArm(vec3 p) {
    uint links = floatBitsToUint(arm[0].x);
    for (uint k = 0; k < links; ++k) {
        if (!within(p, arm[1u + 2u * k])) {
            continue;
        }
        vec4 range = arm[2u + 2u * k];
        uint end = floatBitsToUint(range.y);
        for (uint s = floatBitsToUint(range.x); s < end; ++s) {
            if (within(p, arm[s])) {
                return true;
            }
        }
    }
    return false;
}

// rgb: colour of the same pixel; used only when the colour image is registered.
uint classBits(uvec2 at, float z, vec3 rgb) {
    vec3 p = vec3(rayOf(at) * z, z);
    bool seen = kColour == kColourLookedUp ? colourOf(p, rgb) : kColour == kColourRegistered;
    Hsl colourHere = hslOf(withoutWater(rgb, p));
    vec3 base = kBox != 0 || kSelfFilter != 0 ? transformPoint(params.baseTcamera, p) : vec3(0.0);
    float range = kRange != 0 ? length(p) : 0.0;
    uint mask = 0;
    for (uint c = 0; c < kClasses; ++c) {
        uint member = uint(inClass(params.classes[c], colourHere, seen, base)) & uint(inRange(params.ranges[c], range));
        mask |= member << c;
    }
    mask = z != 0.0 ? mask : 0u;
    if (kSelfFilter != 0 && mask != 0 && onArm(base)) {
        return 0;
    }
    return mask;
}

// Depths [m] of four adjacent pixels in a row; 0 outside the image and where there is no measurement.
vec4 depthsAt(uvec2 at) {
    vec4 z = vec4(0.0);
    if (at.y >= depthSize().y) {
        return z;
    }
    uint pixel = at.y * depthWidth() + at.x;
    if (kFour != 0) {
        bool inside = at.x < depthWidth();
        uvec4 raw = inside ? texelFetch(depths, int(pixel >> 2)) : uvec4(0);
        if (kKeep != 0 && inside) {
            keptDepth[pixel >> 2] = uvec2(raw.x | raw.y << 16, raw.z | raw.w << 16);
        }
        return metresOfFour(raw);
    }
    [[unroll]] for (uint k = 0; k < 4u; ++k) {
        z[k] = at.x + k < depthWidth() ? depthAt(pixel + k) : 0.0;
    }
    return z;
}

// Registered colours of four adjacent pixels in a row; undefined outside the image.
vec3[4] coloursAt(uvec2 at) {
    vec3 rgb[4] = vec3[4](vec3(0.0), vec3(0.0), vec3(0.0), vec3(0.0));
    uvec2 from = all(lessThan(at, depthSize())) ? at : uvec2(0);
    if (kColour == kColourRegistered && kFour == kFourDepthAndColour) {
        rgb = fourColoursAt(from);
    } else if (kColour == kColourRegistered) {
        [[unroll]] for (uint k = 0; k < 4u; ++k) {
            rgb[k] = colourAt(from.x + k < depthWidth() ? from + uvec2(k, 0) : uvec2(0));
        }
    }
    return rgb;
}

// words: per row, class bits of four adjacent pixels, one byte each.
void countPixels(uint words[kRows]) {
    for (uint c = 0; c < kClasses; ++c) {
        uint pixels = 0;
        [[unroll]] for (uint r = 0; r < kRows; ++r) {
            pixels += uint(bitCount(words[r] & 0x01010101u << c));
        }
        if (pixels == 0) {
            continue;
        }
        atomicAdd(counters.classPixels[c], pixels);
    }
}

// Class bits of four adjacent pixels in a row, one byte each.
uint classBitsOfFour(uvec2 at) {
    vec4 z = depthsAt(at);
    vec3 rgb[4] = coloursAt(at);
    uint word = 0;
    [[unroll]] for (uint k = 0; k < 4u; ++k) {
        word |= classBits(at + uvec2(k, 0), z[k], rgb[k]) << (8u * k);
    }
    return word;
}

// First pixel of an invocation. Groups have the layout of patches, so no division is needed.
struct Place {
    uint patchIndex, inside; // slot in the patch
    uvec2 at;
    bool exists; // false beyond the last patch of a row (wide groups)
};

Place placeOf() {
    uint i = gl_WorkGroupID.z * gl_WorkGroupSize.x + gl_LocalInvocationID.x;
    if (kWide != 0) {
        uvec2 at = uvec2(gl_WorkGroupID.x * 64u + (i & 15u) * 4u, gl_WorkGroupID.y * 16u + (i >> 4));
        uint patchX = at.x >> 4;
        bool exists = patchX < patchesAcross();
        uint inside = (at.y >> 2 & 3u) * 64u + (at.x >> 2 & 3u) * 16u + (at.y & 3u) * 4u;
        return Place(exists ? gl_WorkGroupID.y * patchesAcross() + patchX : 0u, inside, at, exists);
    }
    uint inside = i * 4u * kRows;
    return Place(gl_WorkGroupID.y * patchesAcross() + gl_WorkGroupID.x, inside, gl_WorkGroupID.xy * 16u + pixelInPatch(inside), true);
}

// Adds newly marked patches to the lists. The first load races with the atomics of other invocations: bits
// are only set during this pass, so a stale value costs an atomicOr that sets nothing new.
void mark(uint patchIndex, uint bits) {
    if ((listed[patchIndex] & bits) == bits) {
        return;
    }
    uint fresh = bits & ~atomicOr(listed[patchIndex], bits);
    if (kLists != 0 && (fresh & kPatchListed) != 0) {
        appendListed(patchIndex);
        if (kHold != 0 && memoryCounts[patchIndex] >> 16 != 0) {
            atomicOr(listed[patchIndex], kPatchHolding);
        }
    }
    if (kLists != 0 && (fresh & kPatchGuided) != 0) {
        uint place = atomicAdd(counters.guidedGroups.w, 1u);
        list[patchCount() + place] = patchIndex;
        atomicMax(counters.guidedGroups.x, place + 1u);
    }
}

// some: the class bits of all pixels of the invocation, combined by OR in any byte.
void markPatch(Place place, uint some) {
    uint guided = some & ~(forbiddenMask() * 0x01010101u);
    uint bits = some != 0 ? kPatchListed : 0u;
    bits |= kGuidance != 0 && guided != 0 ? kPatchGuided : 0u;
    if (kHold != 0 && kLists != 0 && place.inside == 0 && place.exists) {
        bits |= memoryCounts[place.patchIndex] != 0 ? kPatchListed : 0u;
    }
    mark(place.patchIndex, bits);
}

void main() {
    Place place = placeOf();
    uint word = (place.patchIndex * 256u + place.inside) >> 2, some = 0;
    uint words[kRows];
    [[unroll]] for (uint r = 0; r < kRows; ++r) {
        words[r] = classBitsOfFour(place.at + uvec2(0, r));
        if (kWide == 0 || place.exists) {
            masks[word + r] = words[r];
        }
        some |= words[r];
    }
    countPixels(words);
    markPatch(place, some);
}
