#version 460
// SPDX-License-Identifier: Apache-2.0
// Decides which points the error budget lets it remove. One invocation per 4x4 cell of a listed patch. CPU
// devices only.
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
#include "shaders/shared/constants.h"
#include "shaders/shared/frame_params.h"

layout(local_size_x_id = kSpecGroupSize) in;
layout(constant_id = kSpecClasses) const uint kClasses = 1;

layout(std140, binding = 0) uniform Params { FrameParams params; };
layout(binding = 1) uniform usamplerBuffer masks; // one byte per slot: class bits
// Slot -> point in base axes, relative to the origin [m]; w = 0: none.
layout(binding = 2) uniform samplerBuffer points;
layout(std430, binding = 3) readonly buffer Listed { uint listed[]; };
layout(std430, binding = 4) readonly buffer List { uint list[]; };
layout(std430, binding = 5) readonly buffer Counters { FrameCounters counters; };
// sub-patch -> growth [m] of the corners of its four 2x2 cells; x = -growth when thinned as one 4x4 cell; 0 =
// not thinned.
layout(std430, binding = 6) writeonly buffer Cells { vec4 growth[]; };

#include "shaders/lib/params.glsl"
#include "shaders/lib/masks.glsl"
#include "shaders/lib/forbidden.glsl"
#include "shaders/lib/slots.glsl"
#include "shaders/lib/thin_point.glsl"

const uint kCellPoints = 5u; // a 4x4 cell has 5x5 points with the corners of the next cells; index y * 5 + x
vec3 point[kCellPoints * kCellPoints];
uint kind[kCellPoints * kCellPoints]; // forbidden class, or kNone

// One of the four sub-patches that contain the points: own, right, below, diagonal. Class bits are 0 outside
// the image and in unlisted patches.
struct Quarter {
    uint slot; // slot of its first pixel
    uvec4 rows;
};

Quarter quarterAt(uvec2 at) {
    bool inside = all(lessThan(at, depthSize()));
    uint slot = slotOfPixel(inside ? at : uvec2(0));
    uint used = listed[slot >> 8];
    uvec4 rows = rowsOfMasks(slot >> 4) & forbiddenMask() * 0x01010101u;
    return Quarter(slot, all(bvec2(inside, used != 0)) ? rows : uvec4(0));
}

// Issues all reads before the first use: one memory latency instead of 25.
void readPoints(uvec2 at) {
    Quarter quarters[4] = Quarter[4](quarterAt(at), quarterAt(at + uvec2(4, 0)), quarterAt(at + uvec2(0, 4)), quarterAt(at + uvec2(4, 4)));
    float ranges[kCellPoints * kCellPoints];
    [[unroll]] for (uint i = 0; i < kCellPoints * kCellPoints; ++i) {
        const uint x = i % kCellPoints, y = i / kCellPoints;
        vec4 here = texelFetch(points, int(quarters[y / 4u * 2u + x / 4u].slot + (y & 3u) * 4u + (x & 3u)));
        point[i] = here.xyz;
        ranges[i] = here.w;
    }
    [[unroll]] for (uint i = 0; i < kCellPoints * kCellPoints; ++i) {
        const uint x = i % kCellPoints, y = i / kCellPoints;
        uint mark = maskInRow(quarters[y / 4u * 2u + x / 4u].rows[y & 3u], x & 3u);
        kind[i] = forbiddenClass(ranges[i] != 0.0 ? mark : 0u);
    }
}

// Growth [m] of the corner spheres with which the k x k cell at point `first` can drop all other points. -1:
// the cell is not thinned, because it is not full of one class or the growth exceeds the budget. Unrolled,
// without branches.
float thinned(const uint first, const uint k) {
    const uint c = kind[first];
    float radius = radiusOf(c), most = 0.0;
    Corners corners = cornersOf(point[first], point[first + k], point[first + k * kCellPoints], point[first + k * (kCellPoints + 1u)]);
    uint others = c == kNone ? 1u : 0u;
    [[unroll]] for (uint i = 0; i < (k + 1u) * (k + 1u); ++i) {
        const uint x = i % (k + 1u), y = i / (k + 1u), at = first + y * kCellPoints + x;
        others |= kind[at] ^ c;
        most = max(most, requiredSquare(point[at], corners, float(x) / float(k), float(y) / float(k), radius));
    }
    return others == 0u ? growthOf(most, radius) : -1.0;
}

// Growth [m] of the corners of the four 2x2 cells of the 4x4 cell at a pixel; x = -growth when it is thinned
// as one cell; 0 = not thinned.
vec4 decidedCell(uvec2 at) {
    readPoints(at);
    float whole = thinned(0u, 4u);
    vec4 quarters = max(vec4(0.0), vec4(thinned(0u, 2u), thinned(2u, 2u), thinned(2u * kCellPoints, 2u), thinned(2u * kCellPoints + 2u, 2u)));
    return whole >= 0.0 ? vec4(-whole, 0.0, 0.0, 0.0) : quarters;
}

void main() {
    uint index = gl_GlobalInvocationID.x;
    if (index >= counters.patchGroups.x * 16u) {
        return;
    }
    uint sub = list[index >> 4] * 16u + (index & 15u);
    growth[sub] = decidedCell(pixelOfSlot(sub * 16u));
}
