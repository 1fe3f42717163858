#version 460
// SPDX-License-Identifier: Apache-2.0
// Points of the listed patches in the base frame: rejects flying and isolated pixels and applies the paper's
// Cartesian bilateral filter (eq. 1-2). One group per patch, one invocation per pixel. With kPair one
// invocation per two adjacent pixels, which share the fetches of their windows. With kBlock one per 4x4
// sub-patch (kBlockSub) or per row of one (kBlockRow), with the window in registers.
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
#include "shaders/shared/constants.h"
#include "shaders/shared/frame_params.h"

layout(local_size_x_id = kSpecGroupSize) in;                  // divides 256; with kPair, 128
layout(constant_id = kSpecRays) const uint kRays = 0;
layout(constant_id = kSpecRadius) const uint kRadius = 2;
layout(constant_id = kSpecEdge) const uint kEdge = 1;
layout(constant_id = kSpecTiled) const uint kTiled = 0;

layout(constant_id = kSpecBlock) const uint kBlock = 0;
layout(constant_id = kSpecFour) const uint kFour = 0;
layout(constant_id = kSpecPolynomial) const uint kPolynomial = 0;
layout(constant_id = kSpecPair) const uint kPair = 0;

layout(std140, binding = 0) uniform Params { FrameParams params; };
layout(binding = 1) uniform usamplerBuffer depths; // uint16 per pixel; kFour: four per texel
layout(std430, binding = 2) readonly buffer Rays { vec2 rays[]; };
layout(binding = 3) uniform usamplerBuffer masks; // one byte per slot: class bits
layout(std430, binding = 4) readonly buffer List { uint list[]; };
// Slot -> point in base axes, relative to the origin [m]; w = camera z [m], 0 = none.
layout(std430, binding = 5) writeonly buffer Points { vec4 points[]; };

#include "shaders/lib/depth.glsl"
#include "shaders/lib/lens.glsl"
#include "shaders/lib/masks.glsl"
#include "shaders/lib/pixel_point.glsl"
#include "shaders/lib/slots.glsl"
#include "shaders/lib/bilateral.glsl"

const uint kHalo = kRadius > 1u ? kRadius : 1u;
const uint kTileEdge = kTiled != 0 ? 16u + 2u * kHalo : 1u;
// Points of the window in the camera frame [m]. Each is computed once, though up to 25 pixels read it. One
// array per coordinate avoids bank conflicts.
shared float tileX[kTileEdge * kTileEdge], tileY[kTileEdge * kTileEdge], tileZ[kTileEdge * kTileEdge];

bool outside(ivec2 at) { // avoids && and ||, which branch
    return any(greaterThanEqual(uvec2(at), params.size.xy)); // a negative number converts to a large one
}

float depthOfPixel(ivec2 at) {
    bool beyond = outside(at);
    float z = depthAt(beyond ? 0u : uint(at.y) * params.size.x + uint(at.x));
    return beyond ? 0.0 : z;
}

void fillTile(ivec2 patchOrigin) {
    for (uint i = gl_LocalInvocationID.x; i < kTileEdge * kTileEdge; i += gl_WorkGroupSize.x) {
        ivec2 at = patchOrigin - int(kHalo) + ivec2(i % kTileEdge, i / kTileEdge);
        vec3 p = pointAt(at, depthOfPixel(at));
        tileX[i] = p.x, tileY[i] = p.y, tileZ[i] = p.z;
    }
    barrier();
}

// Camera-frame point at a pixel of the window; z = 0 without depth. With kTiled the pixel must be inside the
// tile.
vec3 windowPoint(ivec2 at, ivec2 patchOrigin) {
    if (kTiled != 0) {
        ivec2 t = at - patchOrigin + int(kHalo);
        int i = t.y * int(kTileEdge) + t.x;
        return vec3(tileX[i], tileY[i], tileZ[i]);
    }
    return pointAt(at, depthOfPixel(at));
}

// The pixel and its eight neighbours, row-major.
vec3[9] aroundOf(ivec2 at, ivec2 patchOrigin) {
    vec3 around[9];
    [[unroll]] for (int k = 0; k < 9; ++k) {
        around[k] = windowPoint(at + ivec2(k % 3 - 1, k / 3 - 1), patchOrigin);
    }
    return around;
}

float[9] depthsOf(vec3 p[9]) {
    return float[9](p[0].z, p[1].z, p[2].z, p[3].z, p[4].z, p[5].z, p[6].z, p[7].z, p[8].z);
}

// Depths of three neighbours on one side. Returns -1 when all valid ones are nearer than z by more than the
// edge threshold, +1 when all are farther, else 0.
float sideJump(vec3 side, float z) {
    float far = max(side.x, max(side.y, side.z)); // 0: no depth there
    vec3 valid = mix(side, vec3(far), equal(side, vec3(0.0)));
    float near = min(valid.x, min(valid.y, valid.z));
    float jump = far < z * (1.0 - params.more.w) ? -1.0 : (near > z * (1.0 + params.more.w) ? 1.0 : 0.0);
    return far == 0.0 ? 0.0 : jump;
}

// A flying pixel mixes two surfaces: nearer neighbours on one side, farther ones on the other. A silhouette
// or a thin rod has jumps of one sign only and is kept.
bool isFlying(float n[9]) {
    float across = sideJump(vec3(n[2], n[5], n[8]), n[4]) * sideJump(vec3(n[0], n[3], n[6]), n[4]);
    float down = sideJump(vec3(n[6], n[7], n[8]), n[4]) * sideJump(vec3(n[0], n[1], n[2]), n[4]);
    return min(across, down) < 0.0;
}

// Fewer than 2 of the 8 neighbours within the isolation distance, as for marine snow and noise.
bool isIsolated(vec3 n[9]) {
    float limit = max(params.filterParams.z, params.filterParams.w * n[4].z);
    uint near = 0;
    [[unroll]] for (int k = 0; k < 9; ++k) {
        near += k != 4 ? uint(n[k].z != 0.0) * uint(distance(n[k], n[4]) <= limit) : 0u;
    }
    return near < 2u;
}

// Paper eq. 1-2: filtered depth [m], with weights from the Cartesian distance between points.
float filtered(ivec2 at, vec3 p, ivec2 patchOrigin) {
    Mean mean = Mean(0.0, 0.0);
    for (int dy = -int(kRadius); dy <= int(kRadius); ++dy) {
        for (int dx = -int(kRadius); dx <= int(kRadius); ++dx) {
            mean = weighed(mean, windowPoint(at + ivec2(dx, dy), patchOrigin), p);
        }
    }
    return filteredDepth(mean, p);
}

bool isRejected(vec3 around[9]) {
    bool flying = kEdge != 0 ? isFlying(depthsOf(around)) : false;
    return any(bvec2(flying, isIsolated(around)));
}

void filterPixel(uint slot, ivec2 patchOrigin) {
    vec4 result = vec4(0.0);
    if (maskAt(slot) != 0) {
        ivec2 at = ivec2(pixelOfSlot(slot, params.size.z));
        vec3 around[9] = aroundOf(at, patchOrigin);
        if (!isRejected(around)) {
            result = basePoint(at, kRadius != 0 ? filtered(at, around[4], patchOrigin) : around[4].z);
        }
    }
    points[slot] = result;
}

// Filters two adjacent pixels. Points in both windows are fetched once; sums keep the order of the
// single-pixel form.
void filterPair(uint slot, ivec2 patchOrigin) {
    uvec2 mask = uvec2(maskAt(slot), maskAt(slot + 1u));
    if (mask == uvec2(0)) {
        points[slot] = vec4(0.0);
        points[slot + 1u] = vec4(0.0);
        return;
    }
    ivec2 at = ivec2(pixelOfSlot(slot, params.size.z));
    vec3 p[2] = vec3[2](windowPoint(at, patchOrigin), windowPoint(at + ivec2(1, 0), patchOrigin));
    Mean mean[2] = Mean[2](Mean(0.0, 0.0), Mean(0.0, 0.0));
    [[unroll]] for (int dy = -2; dy <= 2; ++dy) {
        [[unroll]] for (int x = -2; x <= 3; ++x) {
            vec3 q = windowPoint(at + ivec2(x, dy), patchOrigin);
            [[unroll]] for (int k = 0; k < 2; ++k) {
                mean[k] = x - k >= -2 && x - k <= 2 ? weighed(mean[k], q, p[k]) : mean[k];
            }
        }
    }
    [[unroll]] for (int k = 0; k < 2; ++k) {
        ivec2 here = at + ivec2(k, 0);
        bool shown = mask[k] != 0 && !isRejected(aroundOf(here, patchOrigin));
        points[slot + uint(k)] = shown ? basePoint(here, filteredDepth(mean[k], p[k])) : vec4(0.0);
    }
}

// Size of the window of a 4x4 sub-patch. It holds camera-frame points, z = 0 without depth.
const int kReach = 2, kWide = 4 + 2 * kReach;

// Depths [m] of four adjacent pixels in a row. The first column must be a multiple of four.
vec4 fourDepths(ivec2 q) {
    if (kFour == 0) {
        return vec4(depthOfPixel(q), depthOfPixel(q + ivec2(1, 0)), depthOfPixel(q + ivec2(2, 0)), depthOfPixel(q + ivec2(3, 0)));
    }
    bool beyond = outside(q); // then all four pixels are
    uvec4 raw = texelFetch(depths, beyond ? 0 : int((uint(q.y) * params.size.x + uint(q.x)) >> 2));
    vec4 z = vec4(metresOf(raw.x), metresOf(raw.y), metresOf(raw.z), metresOf(raw.w));
    return beyond ? vec4(0.0) : z;
}

void loadWindow(ivec2 at, out vec3 window[kWide * kWide]) {
    [[unroll]] for (int y = 0; y < kWide; ++y) {
        ivec2 left = at + ivec2(-4, y - kReach);
        vec4 before = fourDepths(left), own = fourDepths(left + ivec2(4, 0)), after = fourDepths(left + ivec2(8, 0));
        float z[kWide] = float[kWide](before.z, before.w, own.x, own.y, own.z, own.w, after.x, after.y);
        [[unroll]] for (int x = 0; x < kWide; ++x) {
            window[y * kWide + x] = pointAt(at + ivec2(x, y) - kReach, z[x]);
        }
    }
}

// Difference from the earlier to the later point of the window, whichever is the centre. So two pixels need
// the same weight, and the compiler computes it once.
vec3 between(vec3 window[kWide * kWide], const int a, const int b) {
    return window[max(a, b)] - window[min(a, b)];
}

// Makes the same decisions and sums in the same order as the per-pixel form. centre: index of the pixel in
// the window.
float surfaceInWindow(vec3 window[kWide * kWide], const int centre, uint mask) {
    float n[9];
    uint near = 0;
    vec3 p = window[centre];
    float limit = max(params.filterParams.z, params.filterParams.w * p.z);
    [[unroll]] for (int i = 0; i < 9; ++i) {
        const int at = centre + (i / 3 - 1) * kWide + i % 3 - 1;
        n[i] = window[at].z;
        bool beside = length(between(window, centre, at)) <= limit;
        near += i != 4 ? uint(n[i] != 0.0) * uint(beside) : 0u;
    }
    bool flying = kEdge != 0 ? isFlying(n) : false;
    bool rejected = any(bvec3(flying, near < 2u, mask == 0u));
    float sum = 0.0, weights = 0.0;
    [[unroll]] for (int dy = -int(min(kRadius, 2u)); dy <= int(min(kRadius, 2u)); ++dy) {
        [[unroll]] for (int dx = -int(min(kRadius, 2u)); dx <= int(min(kRadius, 2u)); ++dx) {
            const int at = centre + dy * kWide + dx;
            vec3 apart = between(window, centre, at);
            float weight = weightOf(dot(apart, apart) * params.filterParams.x);
            weight = window[at].z != 0.0 ? weight : 0.0;
            sum += (window[at].z - p.z) * weight;
            weights += weight;
        }
    }
    float z = kRadius != 0 ? filteredDepth(Mean(sum, weights), p) : p.z;
    return rejected ? 0.0 : z;
}

void filterBlock(uint sub) {
    ivec2 at = ivec2(pixelOfSlot(sub * 16u, params.size.z));
    vec3 window[kWide * kWide];
    loadWindow(at, window);
    uvec4 rows = rowsOfMasks(sub);
    [[unroll]] for (int k = 0; k < 16; ++k) {
        ivec2 in4 = ivec2(k & 3, k >> 2);
        float z = surfaceInWindow(window, (in4.y + kReach) * kWide + in4.x + kReach, maskInRow(rows[k >> 2], uint(k & 3)));
        vec3 base = transformPoint(params.baseTcamera, pointAt(at + in4, z));
        points[sub * 16u + uint(k)] = z != 0.0 ? vec4(base, z) : vec4(0.0);
    }
}

#include "shaders/lib/surface_row.glsl"

void main() {
    uint patchIndex = list[gl_WorkGroupID.x];
    if (kBlock == kBlockSub) {
        filterBlock(patchIndex * 16u + gl_LocalInvocationID.x);
        return;
    }
    if (kBlock == kBlockRow) {
        filterRow(patchIndex * 256u + gl_LocalInvocationID.x * 4u);
        return;
    }
    ivec2 patchOrigin = ivec2(patchIndex % params.size.z, patchIndex / params.size.z) * 16;
    if (kTiled != 0) {
        fillTile(patchOrigin);
    }
    if (kPair != 0) {
        for (uint i = gl_LocalInvocationID.x; i < 128u; i += gl_WorkGroupSize.x) {
            filterPair(patchIndex * 256u + i * 2u, patchOrigin);
        }
        return;
    }
    for (uint i = gl_LocalInvocationID.x; i < 256u; i += gl_WorkGroupSize.x) {
        filterPixel(patchIndex * 256u + i, patchOrigin);
    }
}
