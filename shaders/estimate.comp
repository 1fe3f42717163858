#version 460
// SPDX-License-Identifier: Apache-2.0
// Averages the depth of each pixel over frames, so that a static surface gives the same points in each of
// them. One group per listed patch; one invocation per row of a sub-patch. Avoids branches, as hold.glsl
// does.
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
#include "shaders/shared/constants.h"
#include "shaders/shared/frame_params.h"

layout(local_size_x_id = kSpecGroupSize) in; // divides 64
layout(constant_id = kSpecRays) const uint kRays = 0;
layout(constant_id = kSpecFour) const uint kFour = 0;
layout(constant_id = kSpecMoves) const uint kMoves = 1;

layout(std140, binding = 0) uniform Params { FrameParams params; };
layout(binding = 1) uniform usamplerBuffer depths; // uint16 per pixel; kFour: four per texel
layout(std430, binding = 2) readonly buffer Rays { vec2 rays[]; };
layout(std430, binding = 3) buffer Masks { uint masks[]; };   // one byte per slot: class bits
layout(std430, binding = 4) readonly buffer List { uint list[]; };
layout(std430, binding = 5) buffer Points { vec4 points[]; }; // as `surface` writes it
// Two halves, one slot each per pixel. An odd frame writes the second and reads the first.
layout(binding = 6) uniform usamplerBuffer estimatesBefore;
layout(std430, binding = 7) writeonly buffer Estimates { uvec4 estimates[]; };

#include "shaders/lib/params.glsl"
#include "shaders/lib/depth.glsl"
#include "shaders/lib/lens.glsl"
#include "shaders/lib/transform.glsl"
#include "shaders/lib/pixel_point.glsl"
#include "shaders/lib/slots.glsl"
#include "shaders/lib/estimate.glsl"

// Depths [m] of four adjacent pixels in a row; 0 outside the image.
vec4 fourDepths(uvec2 at) {
    bool beyond = any(greaterThanEqual(at, depthSize()));
    uint pixel = beyond ? 0u : at.y * depthWidth() + at.x;
    vec4 z;
    if (kFour != 0) {
        z = metresOfFour(texelFetch(depths, int(pixel >> 2)));
    } else {
        [[unroll]] for (uint k = 0; k < 4u; ++k) {
            z[k] = at.x + k < depthWidth() ? depthAt(pixel + k) : 0.0;
        }
    }
    return beyond ? vec4(0.0) : z;
}

void estimateRow(uint slot) {
    uvec2 at = pixelOfSlot(slot);
    vec4 raw = fourDepths(at);
    uint word = masks[slot >> 2], kept = 0u;
    vec4 z = vec4(points[slot].w, points[slot + 1u].w, points[slot + 2u].w, points[slot + 3u].w);
    Estimate before[4] = Estimate[4](estimateAt(slot), estimateAt(slot + 1u), estimateAt(slot + 2u), estimateAt(slot + 3u));
    // A loop instead of an `if`: CPU devices run both sides of a branch but skip an empty loop.
    for (uint moved = 0; moved < (kMoves != 0 ? cameraMoved() : 0u); ++moved) {
        [[unroll]] for (uint k = 0; k < 4u; ++k) {
            before[k] = carried(at + uvec2(k, 0), z[k] != 0.0 ? z[k] : raw[k]);
        }
    }
    [[unroll]] for (uint k = 0; k < 4u; ++k) {
        bool seen = all(bvec2(z[k] != 0.0, !isSuddenlyFarther(before[k], raw[k])));
        Estimate now = seen ? updated(before[k], z[k], raw[k], word >> (8u * k) & 255u) : outlasting(before[k], raw[k]);
        vec4 point = basePoint(ivec2(at) + ivec2(k, 0), now.shown);
        points[slot + k] = now.weight != 0u ? point : vec4(0.0);
        kept |= (now.weight != 0u ? now.classes : word >> (8u * k) & 255u) << (8u * k);
        store(slot + k, now);
    }
    masks[slot >> 2] = kept;
}

void main() {
    for (uint row = gl_LocalInvocationID.x; row < 64u; row += gl_WorkGroupSize.x) {
        estimateRow(list[gl_WorkGroupID.x] * 256u + row * 4u);
    }
}
