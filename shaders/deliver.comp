#version 460
// SPDX-License-Identifier: Apache-2.0
// Ends a frame: its counters and the marks of its patches go where the host reads them, and are cleared for the next frame, which
// then begins without a wait for that. One invocation a word.
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/constants.h"
#include "shaders/shared/frame_params.h"

layout(local_size_x_id = kSpecGroupSize) in;

layout(std430, binding = 0) buffer Counters { uint counters[]; }; // words of FrameCounters
layout(std430, binding = 1) buffer Listed { uint listed[]; };     // patch -> kPatch bits
layout(std430, binding = 2) writeonly buffer SetCounters { uint setCounters[]; };
layout(std430, binding = 3) writeonly buffer SetListed { uint setListed[]; };

// A word of counters that count nothing: of indirect arguments y and z are one group.
uint nothing(uint word) {
    return word < kArgumentWords && ((word & 3u) == 1u || (word & 3u) == 2u) ? 1u : 0u;
}

void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i < counters.length()) {
        setCounters[i] = counters[i];
        counters[i] = nothing(i);
    }
    if (i < listed.length()) {
        setListed[i] = listed[i];
        listed[i] = 0;
    }
}
