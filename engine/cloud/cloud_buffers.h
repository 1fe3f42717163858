// SPDX-License-Identifier: Apache-2.0
// Buffers of the frame path: shared between passes, uploaded with a frame, or part of one fixture set.
#pragma once

#include "engine/gpu/buffer.h"
#include "engine/gpu/commands.h"
#include "engine/scene/plan.h"

#include <memory>
#include <vector>

namespace fathom::cloud {

// Buffers that passes share. One copy, because frames run one after the other on the device. Slots are in
// patch-major order.
struct WorkBuffers {
    WorkBuffers(const gpu::Device& device, const Plan& plan, const PatchLayout& layout,
                const CameraInfo& camera);

    gpu::Buffer masks;                // uint8 per slot: class bits
    gpu::Buffer listed;               // uint per patch: kPatch bits
    gpu::Buffer list;                 // uint: patches, any order, in three parts (FrameCounters)
    gpu::Buffer counters;             // FrameCounters
    gpu::Buffer points;               // vec4 per slot
    gpu::Buffer growth;               // vec4 per sub-patch: thinning
    gpu::Buffer seen, kept, keptTime; // vec4, vec4, uint per slot: memory of points
    gpu::Buffer live;                 // uint per patch: points in memory + 65536 x held points
    gpu::Buffer nearest;              // uint per cell of the colour image: occlusion
    gpu::Buffer rays;                 // vec2 per pixel, row-major
    gpu::Buffer radii, heldRadii;     // float a slot: R of the sphere about its point, and about the point in
                                      // `kept`; < 0 = none. Empty with pack
    gpu::Buffer classes; // uint8 a slot: class of the sphere | class of the held one << 4; with pack of
                         // patches with several
    gpu::Buffer depth;   // uint16 per pixel, row-major: copy of the upload; empty unless Plan::keepDepth
    // Without pack the CPU reads points, kept, both radii and classes; with pack only classes, when there are
    // several. listed and counters are clear between frames; each set has a copy.
    gpu::Buffer unused; // bound in place of buffers that the plan skips

    uint32_t cellEdge = 1, cellsAcross = 1, cellsDown = 1; // occlusion cells [colour pixels]
};

// Texel formats of uploads, points and class bits.
inline constexpr VkFormat kDepthTexels = VK_FORMAT_R16_UINT;
inline constexpr VkFormat kPointTexels = VK_FORMAT_R32G32B32A32_SFLOAT;
inline constexpr VkFormat kColourTexels = VK_FORMAT_R8G8B8A8_UINT;
inline constexpr VkFormat kMaskTexels = VK_FORMAT_R32G32B32A32_UINT; // one texel per sub-patch

// Uploads of one frame: parameters and images. Images are copied unless the device can read them in place.
struct UploadBuffers {
    // Imports the memory given here (one image of the camera's size each); throws Error when the device
    // cannot.
    UploadBuffers(const gpu::Device& device, const Plan& plan, const CameraInfo& camera,
                  const std::shared_ptr<const void>& depthMemory = nullptr,
                  const std::shared_ptr<const void>& colourMemory = nullptr);

    gpu::Buffer params; // FrameParams
    gpu::Buffer depth;  // uint16 per pixel, row-major
    gpu::Buffer
        colour; // uint per pixel, or (Plan::yuyv) per two pixels, row-major; empty when no class uses colour
    bool yuyv = false; // Plan::yuyv
    gpu::Buffer arm;   // vec4: links and spheres of the arm, as classify.comp says; empty without self-filter
};

// Device side of one fixture set. Readback buffers are what the CPU copies from.
struct SetBuffers {
    SetBuffers() = default; // none
    SetBuffers(const gpu::Device& device, const Plan& plan, const PatchLayout& layout);

    gpu::Buffer packed; // words: runs of a patch's spheres (shaders/lib/packing.glsl), one after the other in
                        // any order; empty without pack
    gpu::Buffer places; // 16 uint per listed patch, 8 per layer: bit (layer * 256 + slot) = there is a sphere
    gpu::Buffer runs;   // uvec2 per listed patch: first word of its run; number of spheres + 65536 x bits of
                        // their classes, kRunGrown, kRunWide
    gpu::Buffer bits;   // uint per sub-patch of a listed patch: pixels of a forbidden class
    gpu::Buffer nodes;  // vec4 per node; empty without a tree
    gpu::Buffer nodeCounts;    // uint per node
    gpu::Buffer spheres, held; // vec4 per slot, R < 0 = none; for the GPU query, else empty
    gpu::Buffer moments;       // PatchMoments, kMaxClasses per patch
    gpu::Buffer counters;      // FrameCounters
    gpu::Buffer listed;        // uint per patch
    gpu::Buffer points, masks; // copies for guidance classes that need their points
};

// One T per upload slot, made when the slot is first used.
template <class T>
class PerUpload {
public:
    T& operator[](uint32_t upload) {
        if (upload >= all_.size()) {
            all_.resize(upload + 1);
        }
        return all_[upload];
    }
    const T& operator[](uint32_t upload) const { return all_[upload]; }

private:
    std::vector<T> all_;
};

// What passes are made from. Its references outlive the passes.
struct CloudContext {
    const gpu::Device& device;
    const Plan& plan;
    const PatchLayout& layout;
    const CameraInfo& camera;
    const WorkBuffers& work;
    const std::vector<SetBuffers*>& sets;
};

} // namespace fathom::cloud
