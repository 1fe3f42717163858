#version 460
// SPDX-License-Identifier: Apache-2.0
// Not a pass: peak memory rate of the device, for `fathom profile limit` (copy and sum, as in STREAM).
// Invocations stride over the whole buffer. Each loads four independent vectors at a time, so loads overlap,
// and adjacent invocations read adjacent vectors.
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/constants.h"

layout(local_size_x_id = kSpecGroupSize) in;
layout(constant_id = kSpecCopy) const uint kCopy = 0;

layout(std430, binding = 0) readonly buffer From { vec4 from[]; };
layout(std430, binding = 1) writeonly buffer To { vec4 to[]; };
layout(std430, binding = 2) writeonly buffer Sums { float sums[]; };

void main() {
    const uint stride = gl_NumWorkGroups.x * gl_WorkGroupSize.x, count = from.length();
    vec4 sum = vec4(0.0);
    uint i = gl_GlobalInvocationID.x;
    for (; i + 3 * stride < count; i += 4 * stride) {
        vec4 a = from[i], b = from[i + stride], c = from[i + 2 * stride], d = from[i + 3 * stride];
        if (kCopy != 0) {
            to[i] = a;
            to[i + stride] = b;
            to[i + 2 * stride] = c;
            to[i + 3 * stride] = d;
        } else {
            sum += (a + b) + (c + d);
        }
    }
    for (; i < count; i += stride) {
        if (kCopy != 0) {
            to[i] = from[i];
        } else {
            sum += from[i];
        }
    }
    if (kCopy == 0) {
        sums[gl_GlobalInvocationID.x] = (sum.x + sum.y) + (sum.z + sum.w);
    }
}
