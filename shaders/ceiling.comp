#version 460
// SPDX-License-Identifier: Apache-2.0
// Not a pass: peak arithmetic rate of the device, for `fathom profile limit`. Each invocation runs 16
// independent chains of fused multiply-adds, which hides latency, and four steps per round, which hides the
// loop. Writing the sum keeps the compiler from removing the work.
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
#include "shaders/shared/constants.h"

layout(local_size_x_id = kSpecGroupSize) in;
layout(constant_id = kSpecRounds) const uint kRounds = 64;

layout(std430, binding = 0) writeonly buffer Sums { float sums[]; };

void main() {
    float seed = float(gl_GlobalInvocationID.x) * 1e-9;
    vec4 a = vec4(seed, seed + 0.1, seed + 0.2, seed + 0.3), b = a + 0.01, c = a + 0.02, d = a + 0.03;
    for (uint i = 0; i < kRounds; ++i) {
        [[unroll]] for (uint k = 0; k < 4; ++k) {
            a = fma(a, vec4(0.999), vec4(0.001));
            b = fma(b, vec4(0.998), vec4(0.002));
            c = fma(c, vec4(0.997), vec4(0.003));
            d = fma(d, vec4(0.996), vec4(0.004));
        }
    }
    vec4 sum = a + b + c + d;
    sums[gl_GlobalInvocationID.x] = sum.x + sum.y + sum.z + sum.w;
}
