#version 460
// SPDX-License-Identifier: Apache-2.0
// Ends a frame: copies counters and patch marks to buffers that the host reads, then clears them, so the next
// frame needs no clearing pass. One invocation per word. With kTree it also empties the bounds of unlisted
// patches.
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/constants.h"
#include "shaders/shared/frame_params.h"

layout(local_size_x_id = kSpecGroupSize) in;
layout(constant_id = kSpecTree) const uint kTree = 0;

layout(push_constant) uniform Push { TreeParams tree; };
layout(std430, binding = 0) buffer Counters { uint counters[]; }; // words of FrameCounters
layout(std430, binding = 1) buffer Listed { uint listed[]; };     // patch -> kPatch bits
layout(std430, binding = 2) writeonly buffer SetCounters { uint setCounters[]; };
layout(std430, binding = 3) writeonly buffer SetListed { uint setListed[]; };
layout(std430, binding = 4) writeonly buffer Nodes { vec4 nodes[]; };
layout(std430, binding = 5) writeonly buffer NodeCounts { uint nodeCounts[]; };

// The initial value of a counter word: 1 for y and z of indirect arguments, else 0.
uint initialValue(uint word) {
    return word < kArgumentWords && ((word & 3u) == 1u || (word & 3u) == 2u) ? 1u : 0u;
}

void emptyNode(uint patchIndex) {
    nodes[tree.firstPatch + patchIndex] = vec4(0.0, 0.0, 0.0, -1.0);
    nodeCounts[tree.firstPatch + patchIndex] = 0u;
}

void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i < counters.length()) {
        setCounters[i] = counters[i];
        counters[i] = initialValue(i);
    }
    if (i < listed.length()) {
        // listed.length() also counts the words that pad the buffer
        bool isPatch = i < tree.patches;
        if (kTree != 0u && isPatch && listed[i] == 0u) {
            emptyNode(i);
        }
        setListed[i] = listed[i];
        listed[i] = 0;
    }
}
