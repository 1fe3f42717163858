#version 460
// SPDX-License-Identifier: Apache-2.0
// Moments of each guidance class in each guided patch: count, mean, and sums of products about the mean.
// Moments of sub-patches are merged in a fixed order (Chan, Golub, LeVeque 1979). One invocation per patch;
// with kShared a group of 16, one invocation per sub-patch; the first one merges.
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
#include "shaders/shared/constants.h"
#include "shaders/shared/frame_params.h"

layout(local_size_x_id = kSpecGroupSize) in; // kShared: 16
layout(constant_id = kSpecShared) const uint kShared = 0;

layout(std140, binding = 0) uniform Params { FrameParams params; };
layout(binding = 1) uniform usamplerBuffer masks; // one byte per slot: class bits
// Slot -> point in base axes, relative to the origin [m]; w = 0: none.
layout(binding = 2) uniform samplerBuffer points;
layout(std430, binding = 3) readonly buffer List { uint list[]; }; // the part with guided patches
// index: patch * kMaxClasses + number of the guidance class.
layout(std430, binding = 4) writeonly buffer Moments { PatchMoments moments[]; };
layout(std430, binding = 5) readonly buffer Counters { FrameCounters counters; };

#include "shaders/lib/params.glsl"
#include "shaders/lib/masks.glsl"

shared PatchMoments part[kShared != 0 ? 16 : 1];

// No branches: a CPU device executes both sides of each.
PatchMoments subMoments(uint sub, uint c) {
    vec4 point[16]; // w = 1: in the class
    uvec4 rows = rowsOfMasks(sub);
    [[unroll]] for (uint p = 0; p < 16u; ++p) {
        point[p] = texelFetch(points, int(sub * 16u + p));
        uint bit = maskInRow(rows[p >> 2], p & 3u) >> c & 1u;
        point[p].w = all(bvec2(point[p].w != 0.0, bit != 0u)) ? 1.0 : 0.0;
    }
    vec3 sum = vec3(0.0), anchor = vec3(0.0);
    float count = 0.0;
    [[unroll]] for (uint p = 0; p < 16u; ++p) {
        // Near points: their differences from it are exact, so the sums lose no digits.
        anchor = all(bvec2(count == 0.0, point[p].w != 0.0)) ? point[p].xyz : anchor;
        sum += point[p].w != 0.0 ? point[p].xyz - anchor : vec3(0.0);
        count += point[p].w;
    }
    vec3 offset = count > 0.0 ? sum / count : vec3(0.0);
    PatchMoments m = PatchMoments(vec4(anchor, count), vec4(offset, 0.0), vec4(0.0), vec4(0.0));
    [[unroll]] for (uint p = 0; p < 16u; ++p) {
        vec3 d = point[p].w != 0.0 ? (point[p].xyz - anchor) - offset : vec3(0.0);
        m.first += vec4(d.x * d.x, d.x * d.y, d.x * d.z, d.y * d.y);
        m.second.xy += vec2(d.y * d.z, d.z * d.z);
    }
    return m;
}

PatchMoments merge(PatchMoments a, PatchMoments b) {
    if (a.anchor.w == 0.0 || b.anchor.w == 0.0) {
        return a.anchor.w == 0.0 ? b : a;
    }
    float n = a.anchor.w + b.anchor.w, w = a.anchor.w * b.anchor.w / n;
    vec3 d = (b.anchor.xyz - a.anchor.xyz) + (b.offset.xyz - a.offset.xyz);
    vec4 first = a.first + b.first + w * vec4(d.x * d.x, d.x * d.y, d.x * d.z, d.y * d.y);
    vec4 second = a.second + b.second + w * vec4(d.y * d.z, d.z * d.z, 0.0, 0.0);
    return PatchMoments(vec4(a.anchor.xyz, n), vec4(a.offset.xyz + d * (b.anchor.w / n), 0.0), first, second);
}

PatchMoments patchMoments(uint patchIndex, uint c) {
    PatchMoments m = subMoments(patchIndex * 16u, c);
    for (uint s = 1; s < 16u; ++s) {
        m = merge(m, subMoments(patchIndex * 16u + s, c));
    }
    return m;
}

// Called by the whole group; the first invocation has the result.
PatchMoments patchOfGroup(uint patchIndex, uint c) {
    barrier(); // the results of the previous class have been read
    part[gl_LocalInvocationID.x] = subMoments(patchIndex * 16u + gl_LocalInvocationID.x, c);
    barrier();
    PatchMoments m = part[0];
    for (uint s = 1; gl_LocalInvocationID.x == 0 && s < 16u; ++s) {
        m = merge(m, part[s]);
    }
    return m;
}

void main() {
    uint index = kShared != 0 ? gl_WorkGroupID.x : gl_GlobalInvocationID.x;
    if (index >= counters.guidedGroups.w) {
        return;
    }
    uint patchIndex = list[patchCount() + index], k = 0;
    for (uint c = 0; c < classCount(); ++c) {
        if (params.classes[c].role.z == 0.0) {
            continue;
        }
        PatchMoments m = kShared != 0 ? patchOfGroup(patchIndex, c) : patchMoments(patchIndex, c);
        if (kShared == 0 || gl_LocalInvocationID.x == 0) {
            moments[patchIndex * kMaxClasses + k] = m;
        }
        ++k;
    }
}
