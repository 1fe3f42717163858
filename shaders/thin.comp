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

// Class of the pixel at `at`, and of its neighbours up to the corners of the next cells: y * 5 + x. Everything is read before
// anything is looked at: one delay of the memory, not 25.
void readClasses(uvec2 at, out uint classes[25]) {
    uint marks[25];
    float ranges[25];
    for (uint i = 0; i < 25u; ++i) {
        uvec2 p = at + uvec2(i % 5u, i / 5u);
        bool inside = all(lessThan(p, params.size.xy));
        uint slot = slotOfPixel(inside ? p : at, params.size.z);
        uint mark = masks[slot] & params.depthBand.w, used = listed[slot >> 8];
        marks[i] = inside && used != 0 ? mark : 0u;
        ranges[i] = points[slot].w;
    }
    for (uint i = 0; i < 25u; ++i) {
        classes[i] = marks[i] != 0 && ranges[i] != 0.0 ? forbiddenClass(marks[i]) : kNone;
    }
}

vec3 pointOf(uvec2 at) {
    return points[slotOfPixel(at, params.size.z)].xyz;
}

// Growth that lets the k x k cell at `at`, full of one class, drop all but its own corner.
float growthOf(uvec2 at, uint k, float radius) {
    vec3 a = pointOf(at), b = pointOf(at + uvec2(k, 0)), d = pointOf(at + uvec2(0, k)), e = pointOf(at + uvec2(k, k));
    float worst = 0.0;
    for (uint i = 0; i < (k + 1) * (k + 1); ++i) {
        uvec2 step = uvec2(i % (k + 1), i / (k + 1));
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

// Growth within the budget that thins the k x k cell at `from` of the 4x4 cell at `at`; -1 = it is kept whole.
float thinned(uvec2 at, uvec2 from, uint k, uint classes[25]) {
    uint c = classes[from.y * 5u + from.x];
    bool full = c != kNone;
    for (uint i = 0; i < (k + 1) * (k + 1); ++i) {
        full = full && classes[(from.y + i / (k + 1)) * 5u + from.x + i % (k + 1)] == c;
    }
    if (!full) {
        return -1.0;
    }
    float growth = growthOf(at + from, k, params.classes[c].role.x);
    return growth <= params.filterParams.y ? growth : -1.0;
}

void main() {
    uint index = gl_GlobalInvocationID.x;
    if (index >= counters.patchGroups.x * 16u) {
        return;
    }
    uint sub = list[index >> 4] * 16u + (index & 15u);
    uvec2 at = pixelOfSlot(sub * 16u, params.size.z);
    uint classes[25];
    readClasses(at, classes);
    float whole = thinned(at, uvec2(0), 4u, classes);
    vec4 result = vec4(whole >= 0.0 ? -1.0 - whole : 0.0, 0.0, 0.0, 0.0);
    if (whole < 0.0) {
        for (uint q = 0; q < 4u; ++q) {
            result[q] = max(0.0, thinned(at, uvec2((q & 1u) * 2u, (q >> 1) * 2u), 2u, classes));
        }
    }
    growth[sub] = result;
}
