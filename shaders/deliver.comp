#version 460
// SPDX-License-Identifier: Apache-2.0
// Ends a frame: copies counters and patch marks to buffers that the host reads, then clears them, so the next
// frame needs no clearing pass. One invocation per word. With kTree it also ends the region tree: it empties
// the nodes of unlisted patches, and the group that finishes last builds the levels above the patches. So the
// tree costs no dispatch of its own.
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
#include "shaders/shared/constants.h"
#include "shaders/shared/frame_params.h"

layout(local_size_x_id = kSpecGroupSize) in;
layout(constant_id = kSpecTree) const uint kTree = 0;

layout(push_constant) uniform Push { TreeParams tree; };
layout(std430, binding = 0) buffer Counters { uint counters[]; }; // words of FrameCounters
layout(std430, binding = 1) buffer Listed { uint listed[]; };     // patch -> kPatch bits
layout(std430, binding = 2) writeonly buffer SetCounters { uint setCounters[]; };
layout(std430, binding = 3) writeonly buffer SetListed { uint setListed[]; };
layout(std430, binding = 4) coherent buffer Nodes { vec4 nodes[]; };
layout(std430, binding = 5) coherent buffer NodeCounts { uint nodeCounts[]; };

#include "shaders/lib/tree.glsl"

shared uint groupsBefore; // that are done

// The initial value of a counter word: 1 for y and z of indirect arguments, else 0.
uint initialValue(uint word) {
    return word < kArgumentWords && ((word & 3u) == 1u || (word & 3u) == 2u) ? 1u : 0u;
}

void emptyNode(uint patchIndex) {
    uint node = tree.levels[1].z + patchIndex;
    nodes[node] = vec4(0.0, 0.0, 0.0, -1.0);
    nodeCounts[node] = 0u;
}

// True in the group that finishes last, which sees the nodes that all groups wrote. Called by the whole
// group. barrier() orders shared memory only. So the invocation that counts has its own memory barriers next
// to the atomic, which release the nodes of its whole group, and all have one after the last barrier().
bool finishesLast() {
    memoryBarrierBuffer();
    barrier();
    if (gl_LocalInvocationID.x == 0u) {
        memoryBarrierBuffer();
        groupsBefore = atomicAdd(counters[kDeliveredWord], 1u);
        memoryBarrierBuffer();
    }
    barrier();
    memoryBarrierBuffer();
    return groupsBefore == gl_NumWorkGroups.x - 1u;
}

void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i < counters.length() && i != kDeliveredWord) {
        setCounters[i] = counters[i];
        counters[i] = initialValue(i);
    }
    if (i < listed.length()) {
        // listed.length() also counts the words that pad the buffer
        bool isPatch = i < tree.levels[1].x * tree.levels[1].y;
        if (kTree != 0u && isPatch && listed[i] == 0u) {
            emptyNode(i);
        }
        setListed[i] = listed[i];
        listed[i] = 0;
    }
    if (kTree == 0u) {
        return;
    }
    if (finishesLast()) {
        counters[kDeliveredWord] = 0u;
        buildAbovePatches();
    }
}
