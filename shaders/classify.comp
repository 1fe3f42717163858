#version 460
// SPDX-License-Identifier: Apache-2.0
// Which pixels can matter: depth in near..far, colour gates, box on the unfiltered point (paper IV.B). One invocation a
// pixel. The first pixel with a class puts its patch on the list of work; no result depends on the list's order.
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/frame_params.h"

layout(local_size_x_id = 0) in;
layout(constant_id = 1) const uint kRays = 0;    // 1: distorted lens, rays from the table
layout(constant_id = 2) const uint kColour = 1;  // 0 no class asks, 1 registered, 2 looked up through the registration
layout(constant_id = 3) const uint kHold = 0;    // 1: patches that hold points are listed too
layout(constant_id = 4) const uint kGroupSubs = 64; // invocations of the sub-patch passes in a group
layout(constant_id = 5) const uint kClasses = 1;    // classes of points: the loop over them unrolls
layout(constant_id = 6) const uint kBox = 0;        // 1: some class has a box, so that points are needed in the base frame

layout(std140, binding = 0) uniform Params { FrameParams params; };
layout(std430, binding = 1) readonly buffer Depth { uint depthWords[]; };
layout(std430, binding = 2) readonly buffer Rays { vec2 rays[]; };
layout(std430, binding = 3) readonly buffer Colour { uint colour[]; };
layout(std430, binding = 4) readonly buffer Cells { uint nearest[]; };
layout(std430, binding = 5) writeonly buffer Masks { uint masks[]; };       // slot -> class bits
layout(std430, binding = 6) buffer Listed { uint listed[]; };               // patch -> 1 when on the list
layout(std430, binding = 7) writeonly buffer List { uint list[]; };         // patches with work, any order
layout(std430, binding = 8) buffer Counters { FrameCounters counters; };
layout(std430, binding = 9) readonly buffer Live { uint live[]; };          // patch -> points kept in memory

#include "shaders/lib/colour.glsl"
#include "shaders/lib/depth.glsl"
#include "shaders/lib/lens.glsl"
#include "shaders/lib/slots.glsl"

// The colour of a depth pixel; false when the colour camera does not see the point.
bool colourOf(uint pixel, vec3 p, out uint rgba) {
    rgba = 0;
    if (kColour == 1) {
        rgba = colour[pixel];
        return true;
    }
    vec3 q = transformPoint(params.colourTdepth, p);
    if (q.z <= 0.0) {
        return false;
    }
    ivec2 at = ivec2(round(projectPoint(q, params.colourLens, params.colourDistortion, params.more.y)));
    if (any(lessThan(at, ivec2(0))) || any(greaterThanEqual(at, ivec2(params.colourSize.xy)))) {
        return false;
    }
    uvec2 cell = uvec2(at) / params.colourSize.w;
    float front = uintBitsToFloat(nearest[cell.y * params.colourSize.z + cell.x]);
    if (q.z > front * 1.02 + 0.005) {
        return false; // something nearer hides it from the colour camera
    }
    rgba = colour[at.y * int(params.colourSize.x) + at.x];
    return true;
}

bool inClass(ClassParams c, Hsl colourHere, bool seen, vec3 base) {
    bool asks = c.hue.z != 0.0 || c.satLight.x > 0.0 || c.satLight.y < 1.0 || c.satLight.z > 0.0 || c.satLight.w < 1.0;
    if (asks && (!seen || !passesColour(colourHere, c.hue, c.satLight))) {
        return false;
    }
    return c.boxMin.w == 0.0 || (all(greaterThanEqual(base, c.boxMin.xyz)) && all(lessThanEqual(base, c.boxMax.xyz)));
}

void putOnList(uint patchIndex) {
    if (listed[patchIndex] == 0 && atomicExchange(listed[patchIndex], 1u) == 0) {
        uint place = atomicAdd(counters.patchGroups.x, 1u);
        list[place] = patchIndex;
        atomicMax(counters.subGroups.x, (place * 16u + 15u) / kGroupSubs + 1u);
    }
}

uint classBits(uvec2 at, uint pixel, float z) {
    vec3 p = vec3(rayOf(at) * z, z);
    uint rgba = 0;
    bool seen = kColour != 0 && colourOf(pixel, p, rgba);
    Hsl colourHere = hslOf(rgba);
    vec3 base = kBox != 0 ? transformPoint(params.baseTcamera, p) : vec3(0.0);
    uint mask = 0;
    for (uint c = 0; c < kClasses; ++c) {
        if (inClass(params.classes[c], colourHere, seen, base)) {
            mask |= 1u << c;
            atomicAdd(counters.classPixels[c], 1u);
        }
    }
    return mask;
}

void main() {
    // Groups are laid out as the patches are: no division finds the pixel.
    uint patchIndex = gl_WorkGroupID.y * params.size.z + gl_WorkGroupID.x;
    uint inside = gl_WorkGroupID.z * gl_WorkGroupSize.x + gl_LocalInvocationID.x;
    uint slot = patchIndex * 256u + inside;
    uvec2 at = gl_WorkGroupID.xy * 16u + pixelInPatch(inside);
    uint mask = 0;
    if (all(lessThan(at, params.size.xy))) {
        uint pixel = at.y * params.size.x + at.x;
        float z = depthAt(pixel);
        if (z != 0.0) {
            mask = classBits(at, pixel, z);
        }
    }
    masks[slot] = mask;
    if (mask != 0 || (kHold != 0 && inside == 0 && live[patchIndex] != 0)) {
        putOnList(patchIndex);
    }
}
