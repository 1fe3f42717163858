// SPDX-License-Identifier: Apache-2.0
// Buffers of the frame path: what passes hand to each other, what a frame uploads, what one fixture set
// keeps.
#pragma once

#include "engine/gpu/buffer.h"
#include "engine/gpu/commands.h"
#include "engine/scene/plan.h"

#include <array>

namespace fathom::cloud {

inline constexpr uint32_t kUploads = 2; // frames in flight: double-buffered

// What passes hand to each other. One copy: frames run one after the other on the device. Slots are in
// patch-major order.
struct WorkBuffers {
    WorkBuffers(const gpu::Device& device, const Plan& plan, const PatchLayout& layout,
                const CameraInfo& camera);

    gpu::Buffer masks;                // uint a slot: class bits
    gpu::Buffer listed;               // uint a patch: 1 when on the list
    gpu::Buffer list;                 // uint: listed patches, any order
    gpu::Buffer counters;             // FrameCounters
    gpu::Buffer points;               // vec4 a slot
    gpu::Buffer growth;               // vec4 a sub-patch: thinning
    gpu::Buffer seen, kept, keptTime; // vec4, vec4, uint a slot: memory of points
    gpu::Buffer live;                 // uint a patch: points in memory
    gpu::Buffer nearest;              // uint a cell of the colour picture: occlusion
    gpu::Buffer rays;                 // vec2 a pixel, row-major
    gpu::Buffer unused;               // stands in for what the plan leaves out

    uint32_t cellEdge = 1, cellsAcross = 1, cellsDown = 1; // occlusion cells [colour pixels]
};

// What one frame uploads; two of them.
struct UploadBuffers {
    UploadBuffers(const gpu::Device& device, const Plan& plan, const CameraInfo& camera);

    gpu::Buffer params; // FrameParams
    gpu::Buffer depth;  // uint16 a pixel, row-major
    gpu::Buffer colour; // uint a pixel, row-major; empty when no class asks
};

// Device side of one fixture set. Readback buffers are what the CPU copies from.
struct SetBuffers {
    SetBuffers(const gpu::Device& device, const Plan& plan, const PatchLayout& layout);

    gpu::Buffer spheres, held;             // vec4 a slot, only where bits says so
    gpu::Buffer classes;                   // uint a slot, the same
    gpu::Buffer bits;                      // uvec2 a sub-patch of a listed patch: 16 pixels forbidden |
                                           // 16 spheres << 16; 16 held spheres
    gpu::Buffer nodes;                     // vec4 a node
    gpu::Buffer nodeCounts;                // uint a node
    gpu::Buffer deviceSpheres, deviceHeld; // what the GPU query reads; empty without one
    gpu::Buffer moments;                   // PatchMoments, kMaxClasses a patch
    gpu::Buffer counters;                  // FrameCounters
    gpu::Buffer listed;                    // uint a patch
    gpu::Buffer points, masks;             // copies for guidance classes that need their points
};

// Everything a pass needs to know.
struct CloudContext {
    const gpu::Device& device;
    const Plan& plan;
    const PatchLayout& layout;
    const CameraInfo& camera;
    const WorkBuffers& work;
    const std::array<UploadBuffers, kUploads>& uploads;
    const std::vector<SetBuffers*>& sets;
};

} // namespace fathom::cloud
