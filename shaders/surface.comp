#version 460
// SPDX-License-Identifier: Apache-2.0
// Points of the listed patches in the base frame: rejects flying and isolated pixels and applies the paper's
// Cartesian bilateral filter (eq. 1-2). One group per patch, one invocation per pixel. With kPair one
// invocation per two adjacent pixels, which share the fetches of their windows. With kBlock one per 4x4
// sub-patch or two rows of one.
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
#include "shaders/shared/constants.h"
#include "shaders/shared/frame_params.h"

layout(local_size_x_id = kSpecGroupSize) in;                  // divides 256; with kPair, 128
layout(constant_id = kSpecRays) const uint kRays = 0;
layout(constant_id = kSpecRadius) const uint kRadius = 2;
layout(constant_id = kSpecEdge) const uint kEdge = 1;
layout(constant_id = kSpecIsolation) const uint kIsolation = 1;
layout(constant_id = kSpecTiled) const uint kTiled = 0;
layout(constant_id = kSpecBlock) const uint kBlock = 0;
layout(constant_id = kSpecFour) const uint kFour = 0;
layout(constant_id = kSpecWeights) const uint kWeights = kWeightsExponential;
layout(constant_id = kSpecPair) const uint kPair = 0;

layout(std140, binding = 0) uniform Params { FrameParams params; };
layout(binding = 1) uniform usamplerBuffer depths; // uint16 per pixel; kFour: four per texel
layout(std430, binding = 2) readonly buffer Rays { vec2 rays[]; };
layout(binding = 3) uniform usamplerBuffer masks; // one byte per slot: class bits
layout(std430, binding = 4) readonly buffer List { uint list[]; };
// Slot -> point in base axes, relative to the origin [m]; w = camera z [m], 0 = none.
layout(std430, binding = 5) writeonly buffer Points { vec4 points[]; };

#include "shaders/lib/params.glsl"
#include "shaders/lib/depth.glsl"
#include "shaders/lib/masks.glsl"
#include "shaders/lib/transform.glsl"
#include "shaders/lib/pixel_point.glsl"
#include "shaders/lib/slots.glsl"
#include "shaders/lib/bilateral.glsl"

const uint kHalo = kRadius > 1u ? kRadius : 1u;
const uint kTileEdge = kTiled != 0 ? 16u + 2u * kHalo : 1u;
// Points of the window. Each is computed once, though up to 25 pixels read it. One
// array per coordinate avoids bank conflicts.
shared float tileX[kTileEdge * kTileEdge], tileY[kTileEdge * kTileEdge], tileZ[kTileEdge * kTileEdge];

bool outside(ivec2 at) { // avoids && and ||, which branch
    return any(greaterThanEqual(uvec2(at), depthSize())); // a negative number converts to a large one
}

float depthOfPixel(ivec2 at) {
    bool beyond = outside(at);
    float z = depthAt(beyond ? 0u : uint(at.y) * depthWidth() + uint(at.x));
    return beyond ? 0.0 : z;
}

void fillTile(ivec2 patchOrigin) {
    for (uint i = gl_LocalInvocationID.x; i < kTileEdge * kTileEdge; i += gl_WorkGroupSize.x) {
        ivec2 at = patchOrigin - int(kHalo) + ivec2(i % kTileEdge, i / kTileEdge);
        vec3 p = windowPointAt(at, depthOfPixel(at));
        tileX[i] = p.x;
        tileY[i] = p.y;
        tileZ[i] = p.z;
    }
    barrier();
}

// Point of the window at a pixel. With kTiled the pixel must be inside the tile.
vec3 windowPoint(ivec2 at, ivec2 patchOrigin) {
    if (kTiled != 0) {
        ivec2 t = at - patchOrigin + int(kHalo);
        int i = t.y * int(kTileEdge) + t.x;
        return vec3(tileX[i], tileY[i], tileZ[i]);
    }
    return windowPointAt(at, depthOfPixel(at));
}

// The pixel and its eight neighbours, row-major.
vec3[9] neighbourhood(ivec2 at, ivec2 patchOrigin) {
    vec3 around[9];
    [[unroll]] for (int k = 0; k < 9; ++k) {
        around[k] = windowPoint(at + ivec2(k % 3 - 1, k / 3 - 1), patchOrigin);
    }
    return around;
}

// Depths of three neighbours on one side, in any unit. Returns -1 when all valid ones are nearer than z by
// more than the edge threshold, +1 when all are farther, else 0. Non-negative floats compare like their bits,
// which takes fewer instructions. "No depth" is 0, so bits - 1 makes it the largest unsigned value and min()
// ignores it.
float sideJump(vec3 side, float z) {
    uvec3 bits = floatBitsToUint(side);
    uint far = max(bits.x, max(bits.y, bits.z)), near = min(bits.x - 1u, min(bits.y - 1u, bits.z - 1u)) + 1u;
    float jump = uintBitsToFloat(far) < z * (1.0 - edgeJump()) ? -1.0 : (uintBitsToFloat(near) > z * (1.0 + edgeJump()) ? 1.0 : 0.0);
    return far == 0u ? 0.0 : jump;
}

// A flying pixel mixes two surfaces: nearer neighbours on one side, farther ones on the other. A silhouette
// or a thin rod has jumps of one sign only and is kept.
bool isFlying(float n[9]) {
    float across = sideJump(vec3(n[2], n[5], n[8]), n[4]) * sideJump(vec3(n[0], n[3], n[6]), n[4]);
    float down = sideJump(vec3(n[6], n[7], n[8]), n[4]) * sideJump(vec3(n[0], n[1], n[2]), n[4]);
    return min(across, down) < 0.0;
}

// Square of the isolation distance at depth z, both in units of the window.
float isolationSquare(float z) {
    float limit = max(isolationDistance() * windowScale(), isolationSlope() * z);
    return limit * limit;
}

// Fewer than 2 of the 8 neighbours within the isolation distance, as for marine snow and noise. square: of
// their distances; z: of the pixel.
bool isIsolated(float square[9], float z) {
    uint near = 0;
    [[unroll]] for (int k = 0; k < 9; ++k) {
        near += k != 4 ? uint(square[k] <= isolationSquare(z)) : 0u;
    }
    return near < 2u;
}

// Paper eq. 1-2: filtered depth [m], with weights from the Cartesian distance between points.
float filtered(ivec2 at, vec3 p, ivec2 patchOrigin) {
    Mean mean = Mean(0.0, 0.0);
    for (int dy = -int(kRadius); dy <= int(kRadius); ++dy) {
        for (int dx = -int(kRadius); dx <= int(kRadius); ++dx) {
            mean = addWeighted(mean, windowPoint(at + ivec2(dx, dy), patchOrigin), p);
        }
    }
    return filteredDepth(mean, p, depthOfPixel(at));
}

// z, square: as for isFlying and isIsolated.
bool isRejected(float z[9], float square[9]) {
    return any(bvec2(kEdge != 0 ? isFlying(z) : false, kIsolation != 0 ? isIsolated(square, z[4]) : false));
}

bool isRejected(vec3 around[9]) {
    float z[9], square[9];
    [[unroll]] for (int k = 0; k < 9; ++k) {
        vec3 apart = around[k] - around[4];
        z[k] = around[k].z;
        square[k] = dot(apart, apart);
    }
    return isRejected(z, square);
}

void filterPixel(uint slot, ivec2 patchOrigin) {
    vec4 result = vec4(0.0);
    if (maskAt(slot) != 0) {
        ivec2 at = ivec2(pixelOfSlot(slot));
        vec3 around[9] = neighbourhood(at, patchOrigin);
        if (!isRejected(around)) {
            result = basePoint(at, kRadius != 0 ? filtered(at, around[4], patchOrigin) : depthOfPixel(at));
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
    ivec2 at = ivec2(pixelOfSlot(slot));
    vec3 p[2] = vec3[2](windowPoint(at, patchOrigin), windowPoint(at + ivec2(1, 0), patchOrigin));
    Mean mean[2] = Mean[2](Mean(0.0, 0.0), Mean(0.0, 0.0));
    [[unroll]] for (int dy = -2; dy <= 2; ++dy) {
        [[unroll]] for (int x = -2; x <= 3; ++x) {
            vec3 q = windowPoint(at + ivec2(x, dy), patchOrigin);
            [[unroll]] for (int k = 0; k < 2; ++k) {
                mean[k] = x - k >= -2 && x - k <= 2 ? addWeighted(mean[k], q, p[k]) : mean[k];
            }
        }
    }
    [[unroll]] for (int k = 0; k < 2; ++k) {
        ivec2 here = at + ivec2(k, 0);
        bool shown = mask[k] != 0 && !isRejected(neighbourhood(here, patchOrigin));
        points[slot + uint(k)] = shown ? basePoint(here, filteredDepth(mean[k], p[k], depthOfPixel(here))) : vec4(0.0);
    }
}

#include "shaders/lib/surface_block.glsl"

void main() {
    uint patchIndex = list[gl_WorkGroupID.x];
    if (kBlock != 0) {
        if (kRadius > 2u) {
            filterTwoRows(patchIndex * 256u + gl_LocalInvocationID.x * 8u);
        } else if (kRadius != 0u || kEdge != 0u || kIsolation != 0u) {
            filterBlock(patchIndex * 16u + gl_LocalInvocationID.x);
        } else {
            plainBlock(patchIndex * 16u + gl_LocalInvocationID.x);
        }
        return;
    }
    ivec2 patchOrigin = ivec2(patchIndex % patchesAcross(), patchIndex / patchesAcross()) * 16;
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
