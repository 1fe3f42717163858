// SPDX-License-Identifier: Apache-2.0
// Shared by both forms of `spheres`: bindings, and the spheres of one pixel. They compute region spheres of
// the listed patches and bounds of their 4x4 sub-patches (paper IV.B.1, eq. 3). With kHold, points of earlier
// frames that the new frame does not contradict stay as a second layer. Needs kHold, kPack, and seenAt(),
// keptAt(), keptTimeAt(), which read the memory of points.

layout(local_size_x_id = kSpecGroupSize) in; // divides 256
layout(constant_id = kSpecThin) const uint kThin = 1;
layout(constant_id = kSpecLeaks) const uint kLeaks = 1;
layout(constant_id = kSpecClasses) const uint kClasses = 1;
layout(constant_id = kSpecFan) const uint kFan = 0;
layout(constant_id = kSpecBeam) const uint kBeam = 0;
layout(constant_id = kSpecTree) const uint kTree = 1;

layout(std140, binding = 0) uniform Params { FrameParams params; };
layout(binding = 1) uniform usamplerBuffer depths; // uint16 per pixel
layout(binding = 2) uniform usamplerBuffer masks;  // one byte per slot: class bits
// Per slot: point in base axes, relative to the origin [m]; w = camera z [m], 0 = none.
layout(binding = 3) uniform samplerBuffer points;
layout(std430, binding = 4) readonly buffer Listed { uint listed[]; }; // patch -> kPatch bits
layout(std430, binding = 5) readonly buffer List { uint list[]; };     // frame_params.h describes its parts
layout(std430, binding = 6) buffer Counters { FrameCounters counters; };
// Slot -> point of the previous frame; w = its note (hold.glsl).
layout(std430, binding = 7) buffer Seen { vec4 seen[]; };
// Slot -> held point; w = its note.
layout(std430, binding = 8) buffer Kept { vec4 kept[]; };
layout(std430, binding = 9) buffer KeptTime { uint keptTime[]; }; // slot -> time when it was last seen [us]
// Patch -> points in memory + 65536 x held points.
layout(std430, binding = 10) buffer Memory { uint memoryCounts[]; };
// Slot -> centre, R; R < 0 = none.
layout(std430, binding = 11) writeonly buffer Spheres { vec4 spheres[]; };
layout(std430, binding = 12) writeonly buffer Held { vec4 held[]; }; // the same for held points
// One byte per slot: class of the sphere | class of the held one << 4.
layout(std430, binding = 13) writeonly buffer Classes { uvec4 classes[]; };
// Sub-patch -> 16 pixels; 1 = forbidden class.
layout(std430, binding = 14) writeonly buffer Bits { uint bits[]; };
layout(std430, binding = 15) writeonly buffer Nodes { vec4 nodes[]; };
layout(std430, binding = 16) writeonly buffer NodeCounts { uint nodeCounts[]; };
// Per row of a sub-patch: R of its four points; < 0 = none.
layout(std430, binding = 17) writeonly buffer Radii { vec4 radii[]; };
// The same for the held points in kept.
layout(std430, binding = 18) writeonly buffer HeldRadii { vec4 heldRadii[]; };

// As Classes, in the fixture set.
layout(std430, binding = 23) writeonly buffer SetClasses { uvec4 setClasses[]; };

const uint kRays = 0; // this pass needs no rays
const vec2 rays[1] = vec2[1](vec2(0.0));
#include "shaders/lib/params.glsl"
#include "shaders/lib/beam.glsl"
#include "shaders/lib/depth.glsl"
#include "shaders/lib/masks.glsl"
#include "shaders/lib/forbidden.glsl"
#include "shaders/lib/lens.glsl"
#include "shaders/lib/transform.glsl"
#include "shaders/lib/hold.glsl"
#include "shaders/lib/slots.glsl"
#include "shaders/lib/leaks.glsl"
#include "shaders/lib/thinning.glsl"
#include "shaders/lib/seen_sphere.glsl"

const uint kLayers = kHold != 0 ? 2u : 1u;

struct PixelResult {
    vec4 sphere, held; // R < 0 = none
    float z;           // camera z of the seen point [m]
    // 1 = forbidden class; 2 = seen point is remembered; 4 = held point is remembered; 256 x class of the
    // sphere; 4096 x class of the held one; 65536 x growth steps.
    uint note;
};

// Handles pixel p (0..15) of sub-patch `sub`, whose first pixel is `corner`. holding: the patch's memory
// holds points.
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

// Combined results of the pixels of a sub-patch.
struct Notes {
    uint marks;      // one bit per pixel of a forbidden class
    uint remembered; // remembered points, encoded as in `memoryCounts`
    uvec4 classes;   // one byte per pixel
};

Notes noted(Notes n, const uint p, uint note) {
    n.marks |= (note & 1u) << p;
    n.remembered += (note >> 1 & 1u) + (note >> 2 & 1u) * 65537u;
    n.classes[p >> 2] |= (note >> 8 & 255u) << ((p & 3u) * 8u);
    return n;
}

// Paper eq. 3: centre = mean, radius = max(|s_k - centre| + r_k), rounded outward; < 0 = empty. Sums in fixed
// order.
vec4 outward(vec3 centre, float radius) {
    return vec4(centre, radius >= 0.0 ? radius * 1.000001 + 1e-7 : -1.0);
}

void putBound(uint sub, vec4 bound, uint count, Notes notes) {
    bits[sub] = notes.marks;
    if (kTree != 0) {
        nodes[sub] = bound;
        nodeCounts[sub] = count;
        if (kClasses > 1) {
            setClasses[sub] = notes.classes;
        }
    }
}

// Float bits of the radius; 0 = no sphere, or one with a number that is not finite, which no query finds.
// Such bits have the order of their radii.
uint radiusBits(vec4 sphere) {
    bool finite = all(notEqual(floatBitsToUint(sphere) & uvec4(0x7f800000u), uvec4(0x7f800000u)));
    return finite && sphere.w > 0.0 ? floatBitsToUint(sphere.w) : 0u;
}

// Class of a pixel's sphere in its sub-patch. layer: 0 = seen, 1 = held.
uint classIn(Notes notes, uint p, uint layer) {
    return notes.classes[p >> 2] >> ((p & 3u) * 8u + layer * 4u) & 15u;
}

// bits: largest radiusBits() of some spheres of class c.
void noteLargest(uint c, uint bits) {
    if (bits != 0) {
        atomicMax(counters.largestRadius[c], bits);
    }
}

// Writes the radii of row k of a sub-patch: seen and held points.
void putRadii(uint sub, uint k, vec4 seenHere, vec4 heldHere) {
    if (kPack == 0) {
        radii[sub * 4u + k] = seenHere;
        if (kHold != 0) {
            heldRadii[sub * 4u + k] = heldHere;
        }
    }
}
