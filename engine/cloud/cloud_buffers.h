// SPDX-License-Identifier: Apache-2.0
// Buffers of the frame path: what passes hand to each other, what a frame uploads, what one fixture set
// keeps.
#pragma once

#include "engine/gpu/buffer.h"
#include "engine/gpu/commands.h"
#include "engine/scene/plan.h"

#include <memory>
#include <vector>

namespace fathom::cloud {

// What passes hand to each other. One copy: frames run one after the other on the device. Slots are in
// patch-major order.
struct WorkBuffers {
    WorkBuffers(const gpu::Device& device, const Plan& plan, const PatchLayout& layout,
                const CameraInfo& camera);

    gpu::Buffer masks;                // uint8 a slot: class bits
    gpu::Buffer listed;               // uint a patch: kPatch bits
    gpu::Buffer list;                 // uint: patches, any order, in three parts (FrameCounters)
    gpu::Buffer counters;             // FrameCounters
    gpu::Buffer points;               // vec4 a slot
    gpu::Buffer growth;               // vec4 a sub-patch: thinning
    gpu::Buffer seen, kept, keptTime; // vec4, vec4, uint a slot: memory of points
    gpu::Buffer live;                 // uint a patch: points in memory + 65536 x held ones
    gpu::Buffer nearest;              // uint a cell of the colour picture: occlusion
    gpu::Buffer rays;                 // vec2 a pixel, row-major
    gpu::Buffer radii, heldRadii;     // float a slot: R of the sphere about its point, and about the point in
                                      // `kept`; < 0 = none. Empty with pack
    gpu::Buffer classes; // uint8 a slot: class of the sphere | class of the held one << 4; with pack of
                         // patches with several
    gpu::Buffer depth;   // uint16 a pixel, row-major: what classify read; empty unless kept
    // points, kept, both radii and classes are what the CPU reads when the plan packs nothing; else classes,
    // where there are several. listed and counters are clear between frames: a set has what they were.
    gpu::Buffer unused; // stands in for what the plan leaves out

    uint32_t cellEdge = 1, cellsAcross = 1, cellsDown = 1; // occlusion cells [colour pixels]
};

// How passes fetch what a frame uploads, points and class bits.
inline constexpr VkFormat kDepthTexels = VK_FORMAT_R16_UINT;
inline constexpr VkFormat kPointTexels = VK_FORMAT_R32G32B32A32_SFLOAT;
inline constexpr VkFormat kColourTexels = VK_FORMAT_R8G8B8A8_UINT;
inline constexpr VkFormat kMaskTexels = VK_FORMAT_R32G32B32A32_UINT; // a texel a sub-patch

// What one frame uploads: parameters, and pictures, which are copied unless they can be read where they are.
struct UploadBuffers {
    // Pictures named here (of the camera's size) are imported; throws Error when the device cannot.
    UploadBuffers(const gpu::Device& device, const Plan& plan, const CameraInfo& camera,
                  const std::shared_ptr<const void>& depthMemory = nullptr,
                  const std::shared_ptr<const void>& colourMemory = nullptr);

    gpu::Buffer params; // FrameParams
    gpu::Buffer depth;  // uint16 a pixel, row-major
    gpu::Buffer colour; // uint a pixel, or (Plan::yuyv) two pixels, row-major; empty when no class asks
    bool yuyv = false;  // Plan::yuyv
    gpu::Buffer arm; // vec4: links and spheres of the arm, as classify.comp says; empty without self-filter
};

// Device side of one fixture set. Readback buffers are what the CPU copies from.
struct SetBuffers {
    SetBuffers() = default; // none
    SetBuffers(const gpu::Device& device, const Plan& plan, const PatchLayout& layout);

    gpu::Buffer packed; // words: runs of a patch's spheres (shaders/lib/packing.glsl), one after the other in
                        // any order; empty without pack
    gpu::Buffer places; // 16 uint a listed patch, 8 a layer: bit (layer * 256 + slot) = there is a sphere
    gpu::Buffer runs;   // uvec2 a listed patch: first word of its run; how many spheres + 65536 x bits of
                        // their classes, kRunGrown, kRunWide
    gpu::Buffer bits;   // uint a sub-patch of a listed patch: pixels of a forbidden class
    gpu::Buffer nodes;  // vec4 a node; empty without a tree
    gpu::Buffer nodeCounts;    // uint a node
    gpu::Buffer spheres, held; // vec4 a slot, R < 0 = none: what the GPU query reads; empty without one
    gpu::Buffer moments;       // PatchMoments, kMaxClasses a patch
    gpu::Buffer counters;      // FrameCounters
    gpu::Buffer listed;        // uint a patch
    gpu::Buffer points, masks; // copies for guidance classes that need their points
};

// Depth for the passes after classify.
inline const gpu::Buffer& depthOf(const WorkBuffers& work, const UploadBuffers& upload) {
    return work.depth ? work.depth : upload.depth;
}

// A T for each of the slots that frames are uploaded to, made when a slot comes into use.
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

// Everything a pass needs to know; what it refers to outlives the passes.
struct CloudContext {
    const gpu::Device& device;
    const Plan& plan;
    const PatchLayout& layout;
    const CameraInfo& camera;
    const WorkBuffers& work;
    const std::vector<SetBuffers*>& sets;
};

} // namespace fathom::cloud
