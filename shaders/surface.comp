#version 460
// SPDX-License-Identifier: Apache-2.0
// Points of the listed patches: flying and isolated pixels rejected, the paper's Cartesian bilateral filter (eq. 1-2),
// base frame. One group a patch, one invocation a pixel, or (kRow) four pixels of a row that share their window in registers.
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
#include "shaders/shared/frame_params.h"

layout(local_size_x_id = 0) in;                  // 256
layout(constant_id = 1) const uint kRays = 0;
layout(constant_id = 2) const uint kRadius = 2;  // filter window (2 r + 1)^2; 0 compiles the filter out
layout(constant_id = 3) const uint kEdge = 1;    // 1: flying pixels are rejected
layout(constant_id = 4) const uint kTiled = 0;   // 1: the window comes from shared memory (the paper); 0: direct reads

layout(constant_id = 5) const uint kRow = 0;     // 1: four pixels of a row an invocation, radius at most 2
layout(constant_id = 6) const uint kEven = 0;    // 1: the picture's width is even: two neighbours are one word

layout(constant_id = 7) const uint kPolynomial = 0; // 1: weights by a power of a line, which has no exp and ends at 0

layout(std140, binding = 0) uniform Params { FrameParams params; };
layout(std430, binding = 1) readonly buffer Depth { uint depthWords[]; };
layout(std430, binding = 2) readonly buffer Rays { vec2 rays[]; };
layout(std430, binding = 3) readonly buffer Masks { uint masks[]; };
layout(std430, binding = 4) readonly buffer List { uint list[]; };
layout(std430, binding = 5) writeonly buffer Points { vec4 points[]; }; // slot -> base point about the origin, w = z [m]; 0 = none

#include "shaders/lib/depth.glsl"
#include "shaders/lib/lens.glsl"
#include "shaders/lib/slots.glsl"

const uint kHalo = kRadius > 1u ? kRadius : 1u;
const uint kTileEdge = kTiled != 0 ? 16u + 2u * kHalo : 1u;
shared float tile[kTileEdge * kTileEdge];

float depthOfPixel(ivec2 at) {
    if (any(lessThan(at, ivec2(0))) || any(greaterThanEqual(at, ivec2(params.size.xy)))) {
        return 0.0;
    }
    return depthAt(uint(at.y) * params.size.x + uint(at.x));
}

void fillTile(ivec2 patchOrigin) {
    for (uint i = gl_LocalInvocationID.x; i < kTileEdge * kTileEdge; i += gl_WorkGroupSize.x) {
        tile[i] = depthOfPixel(patchOrigin - int(kHalo) + ivec2(i % kTileEdge, i / kTileEdge));
    }
    barrier();
}

// Depth at a pixel of the window; within the tile when there is one.
float windowDepth(ivec2 at, ivec2 patchOrigin) {
    if (kTiled != 0) {
        ivec2 t = at - patchOrigin + int(kHalo);
        return tile[t.y * int(kTileEdge) + t.x];
    }
    return depthOfPixel(at);
}

vec3 pointAt(ivec2 at, float z) {
    return vec3(rayOf(uvec2(at)) * z, z);
}

// The pixel and its eight neighbours, row by row; 0 = no depth there.
float[9] aroundOf(ivec2 at, ivec2 patchOrigin) {
    float around[9];
    for (int k = 0; k < 9; ++k) {
        around[k] = windowDepth(at + ivec2(k % 3 - 1, k / 3 - 1), patchOrigin);
    }
    return around;
}

// Three neighbours on one side. -1: all valid ones are nearer than z by more than the edge; +1: all farther; 0: neither.
int sideJump(vec3 side, float z) {
    bvec3 valid = notEqual(side, vec3(0.0));
    bvec3 nearer = lessThan(side, vec3(z * (1.0 - params.more.w))), farther = greaterThan(side, vec3(z * (1.0 + params.more.w)));
    bool allNearer = all(equal(valid, bvec3(uvec3(valid) * uvec3(nearer))));
    bool allFarther = all(equal(valid, farther)); // no depth is never farther
    return !any(valid) ? 0 : (allNearer ? -1 : (allFarther ? 1 : 0));
}

// Between a nearer surface on one side and a farther one on the other: a mixed pixel that lies on neither. A silhouette or
// a thin rod has jumps of one sign only and stays.
bool isFlying(float n[9]) {
    return sideJump(vec3(n[2], n[5], n[8]), n[4]) * sideJump(vec3(n[0], n[3], n[6]), n[4]) < 0 ||
           sideJump(vec3(n[6], n[7], n[8]), n[4]) * sideJump(vec3(n[0], n[1], n[2]), n[4]) < 0;
}

// Fewer than 2 of the 8 neighbours within the isolation distance: marine snow, a speck of noise.
bool isIsolated(ivec2 at, float n[9]) {
    float limit = max(params.filterParams.z, params.filterParams.w * n[4]);
    vec3 p = pointAt(at, n[4]);
    int near = 0;
    for (int k = 0; k < 9; ++k) {
        ivec2 q = at + ivec2(k % 3 - 1, k / 3 - 1);
        near += k != 4 && n[k] != 0.0 && distance(pointAt(q, n[k]), p) <= limit ? 1 : 0;
    }
    return near < 2;
}

// Paper eq. 2 of t = distance^2 / (2 sigma^2). The power touches exp(-t) at 0 and is at most 0.008 off anywhere.
float weightOf(float t) {
    if (kPolynomial == 0) {
        return exp(-t);
    }
    float w = max(0.0, 1.0 - t * (1.0 / 16.68));
    w *= w;
    w *= w;
    w *= w;
    return w * w;
}

// Paper eq. 1-2: v the depth value, weights by the Cartesian distance between the points.
float filtered(ivec2 at, vec3 p, ivec2 patchOrigin) {
    float sum = 0.0, weights = 0.0;
    for (int dy = -int(kRadius); dy <= int(kRadius); ++dy) {
        for (int dx = -int(kRadius); dx <= int(kRadius); ++dx) {
            ivec2 q = at + ivec2(dx, dy);
            float d = windowDepth(q, patchOrigin);
            if (d != 0.0) {
                vec3 apart = pointAt(q, d) - p;
                float weight = weightOf(dot(apart, apart) * params.filterParams.x);
                // Summed as differences from the centre: the mean keeps all digits of a distant surface.
                sum += (d - p.z) * weight;
                weights += weight;
            }
        }
    }
    return p.z + sum / weights; // weights >= 1: the centre itself
}

// The window of four pixels of a row: points of the camera frame, z = 0 where there is no depth.
const int kReach = 2;
const int kWide = 4 + 2 * kReach, kHigh = 1 + 2 * kReach;

void loadRow(ivec2 at, out vec3 window[kHigh * kWide]) {
    [[unroll]] for (int y = 0; y < kHigh; ++y) {
        [[unroll]] for (int x = 0; x < kWide; x += 2) {
            ivec2 q = at + ivec2(x - kReach, y - kReach);
            float z0 = 0.0, z1 = 0.0;
            if (kEven != 0) { // both inside or both outside, and in one word
                if (all(greaterThanEqual(q, ivec2(0))) && all(lessThan(q, ivec2(params.size.xy)))) {
                    uint word = depthWords[(uint(q.y) * params.size.x + uint(q.x)) >> 1];
                    z0 = metresOf(word & 0xffffu);
                    z1 = metresOf(word >> 16);
                }
            } else {
                z0 = depthOfPixel(q);
                z1 = depthOfPixel(q + ivec2(1, 0));
            }
            vec3 p0 = vec3(0.0), p1 = vec3(0.0);
            if (kRays == 0 || z0 != 0.0) {
                p0 = pointAt(q, z0);
            }
            if (kRays == 0 || z1 != 0.0) {
                p1 = pointAt(q + ivec2(1, 0), z1);
            }
            window[y * kWide + x] = p0;
            window[y * kWide + x + 1] = p1;
        }
    }
}

// The same decisions and sums as below, pixel by pixel, in the same order.
vec4 surfaceInRow(vec3 window[kHigh * kWide], int k, uint mask) {
    float n[9];
    int near = 0;
    vec3 p = window[kReach * kWide + kReach + k];
    float limit = max(params.filterParams.z, params.filterParams.w * p.z);
    [[unroll]] for (int i = 0; i < 9; ++i) {
        vec3 q = window[(kReach + i / 3 - 1) * kWide + kReach + k + i % 3 - 1];
        n[i] = q.z;
        near += i != 4 && q.z != 0.0 && distance(q, p) <= limit ? 1 : 0;
    }
    bool rejected = (kEdge != 0 && isFlying(n)) || near < 2 || mask == 0;
    float sum = 0.0, weights = 0.0;
    [[unroll]] for (int dy = -int(min(kRadius, 2u)); dy <= int(min(kRadius, 2u)); ++dy) {
        [[unroll]] for (int dx = -int(min(kRadius, 2u)); dx <= int(min(kRadius, 2u)); ++dx) {
            vec3 q = window[(kReach + dy) * kWide + kReach + k + dx];
            vec3 apart = q - p;
            float weight = q.z != 0.0 ? weightOf(dot(apart, apart) * params.filterParams.x) : 0.0;
            sum += (q.z - p.z) * weight;
            weights += weight;
        }
    }
    float z = kRadius != 0 ? p.z + sum / weights : p.z;
    return rejected ? vec4(0.0) : vec4(0.0, 0.0, 0.0, z);
}

void filterRow(uint patchIndex, uint row) {
    uint slot = patchIndex * 256u + row * 4u;
    uvec4 mask = uvec4(masks[slot], masks[slot + 1u], masks[slot + 2u], masks[slot + 3u]);
    ivec2 at = ivec2(pixelOfSlot(slot, params.size.z));
    vec3 window[kHigh * kWide];
    loadRow(at, window);
    [[unroll]] for (int k = 0; k < 4; ++k) {
        vec4 result = surfaceInRow(window, k, mask[k]);
        if (result.w != 0.0) {
            result.xyz = transformPoint(params.baseTcamera, pointAt(at + ivec2(k, 0), result.w));
        }
        points[slot + uint(k)] = result;
    }
}

void main() {
    uint patchIndex = list[gl_WorkGroupID.x];
    if (kRow != 0) {
        for (uint row = gl_LocalInvocationID.x; row < 64u; row += gl_WorkGroupSize.x) {
            filterRow(patchIndex, row);
        }
        return;
    }
    ivec2 patchOrigin = ivec2(patchIndex % params.size.z, patchIndex / params.size.z) * 16;
    if (kTiled != 0) {
        fillTile(patchOrigin);
    }
    for (uint i = gl_LocalInvocationID.x; i < 256u; i += gl_WorkGroupSize.x) {
        uint slot = patchIndex * 256u + i;
        vec4 result = vec4(0.0);
        if (masks[slot] != 0) {
            ivec2 at = ivec2(pixelOfSlot(slot, params.size.z));
            float around[9] = aroundOf(at, patchOrigin);
            if (!(kEdge != 0 && isFlying(around)) && !isIsolated(at, around)) {
                vec3 p = pointAt(at, around[4]);
                float z = kRadius != 0 ? filtered(at, p, patchOrigin) : p.z;
                result = vec4(transformPoint(params.baseTcamera, pointAt(at, z)), z);
            }
        }
        points[slot] = result;
    }
}
