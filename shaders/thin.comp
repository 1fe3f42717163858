#version 460
// SPDX-License-Identifier: Apache-2.0
// Which points the error budget can do without. One invocation a 4x4 cell of a listed patch.
//
// A dropped point q with q' = sum l_i p_i, the bilinear mean of the cell's four corner points, V = sum l_i |p_i - q'|^2 and
// e = |q - q'| is covered by its corners when they have the radius R' = sqrt((R + e)^2 + V): for every x,
// min_i |x - p_i|^2 <= sum l_i |x - p_i|^2 = |x - q'|^2 + V. So corners that grow by R' - R lose nothing of the region, in any
// direction, on any slope; on a flat square of spacing s the growth is s^2 / (4 R). A cell is thinned only when it is full of
// one class and the growth stays within the budget: first 4x4, else each 2x2.
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/frame_params.h"

layout(local_size_x_id = 0) in;

layout(std140, binding = 0) uniform Params { FrameParams params; };
layout(std430, binding = 1) readonly buffer Masks { uint masks[]; };
layout(std430, binding = 2) readonly buffer Points { vec4 points[]; };
layout(std430, binding = 3) readonly buffer Listed { uint listed[]; };
layout(std430, binding = 4) readonly buffer List { uint list[]; };
layout(std430, binding = 5) readonly buffer Counters { FrameCounters counters; };
layout(std430, binding = 6) writeonly buffer Cells { vec4 growth[]; }; // sub-patch -> growth of the corners of its four 2x2 cells;
                                                                   // x = -1 - growth when thinned as one 4x4 cell; 0 = kept whole

#include "shaders/lib/forbidden.glsl"
#include "shaders/lib/slots.glsl"

uint classOf(uvec2 at) {
    if (any(greaterThanEqual(at, params.size.xy)) || listed[(at.y >> 4) * params.size.z + (at.x >> 4)] == 0) {
        return kNone;
    }
    return forbiddenAt(slotOfPixel(at, params.size.z));
}

vec3 pointOf(uvec2 at) {
    return points[slotOfPixel(at, params.size.z)].xyz;
}

// Growth that lets the k x k cell at `at` drop all but its own corner; -1 when the cell is not full of one class.
float growthOf(uvec2 at, uint k, float radius, uint c) {
    vec3 a = pointOf(at), b = pointOf(at + uvec2(k, 0)), d = pointOf(at + uvec2(0, k)), e = pointOf(at + uvec2(k, k));
    float worst = 0.0;
    for (uint i = 0; i < (k + 1) * (k + 1); ++i) {
        uvec2 step = uvec2(i % (k + 1), i / (k + 1));
        if (classOf(at + step) != c) {
            return -1.0;
        }
        vec2 t = vec2(step) / float(k);
        vec4 l = vec4((1.0 - t.x) * (1.0 - t.y), t.x * (1.0 - t.y), (1.0 - t.x) * t.y, t.x * t.y);
        vec3 mean = l.x * a + l.y * b + l.z * d + l.w * e;
        vec4 apart = vec4(dot(a - mean, a - mean), dot(b - mean, b - mean), dot(d - mean, d - mean), dot(e - mean, e - mean));
        // R' - R without the cancellation of two nearly equal radii
        float off = distance(pointOf(at + step), mean), spread = dot(l, apart);
        float more = off * (2.0 * radius + off) + spread;
        worst = max(worst, more / (sqrt(radius * radius + more) + radius));
    }
    return worst * 1.0001 + 1e-8; // outward
}

void main() {
    uint index = gl_GlobalInvocationID.x;
    if (index >= counters.patchGroups.x * 16u) {
        return;
    }
    uint sub = list[index >> 4] * 16u + (index & 15u);
    uvec2 at = pixelOfSlot(sub * 16u, params.size.z);
    vec4 result = vec4(0.0);
    uint c = classOf(at);
    float whole = c == kNone ? -1.0 : growthOf(at, 4u, params.classes[c].role.x, c);
    if (whole >= 0.0 && whole <= params.filterParams.y) {
        result.x = -1.0 - whole;
    } else {
        for (uint q = 0; q < 4u; ++q) {
            uvec2 corner = at + uvec2((q & 1u) * 2u, (q >> 1) * 2u);
            uint own = classOf(corner);
            float grown = own == kNone ? -1.0 : growthOf(corner, 2u, params.classes[own].role.x, own);
            result[q] = grown >= 0.0 && grown <= params.filterParams.y ? grown : 0.0;
        }
    }
    growth[sub] = result;
}
