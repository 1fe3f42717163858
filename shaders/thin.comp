#version 460
// SPDX-License-Identifier: Apache-2.0
// Which points the error budget can do without. One invocation a 4x4 cell of a listed patch.
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
#include "shaders/shared/frame_params.h"

layout(local_size_x_id = 0) in;
layout(constant_id = 1) const uint kClasses = 1; // classes of points

layout(std140, binding = 0) uniform Params { FrameParams params; };
layout(binding = 1) uniform usamplerBuffer masks; // a byte a slot: class bits
layout(binding = 2) uniform samplerBuffer points; // a slot: base point about the origin, w = 0: none
layout(std430, binding = 3) readonly buffer Listed { uint listed[]; };
layout(std430, binding = 4) readonly buffer List { uint list[]; };
layout(std430, binding = 5) readonly buffer Counters { FrameCounters counters; };
layout(std430, binding = 6) writeonly buffer Cells { vec4 growth[]; }; // sub-patch -> growth of the corners of its four 2x2 cells;
                                                                   // x = -growth when thinned as one 4x4 cell; 0 = kept whole

#include "shaders/lib/masks.glsl"
#include "shaders/lib/forbidden.glsl"
#include "shaders/lib/slots.glsl"
#include "shaders/lib/thin_cell.glsl"

void main() {
    uint index = gl_GlobalInvocationID.x;
    if (index >= counters.patchGroups.x * 16u) {
        return;
    }
    uint sub = list[index >> 4] * 16u + (index & 15u);
    growth[sub] = decidedCell(pixelOfSlot(sub * 16u, params.size.z));
}
