// SPDX-License-Identifier: Apache-2.0
// Buffers of the frame cadence: shared by the passes, uploaded with each frame, or part of one fixture set.
#pragma once

#include "engine/gpu/buffer.h"
#include "engine/gpu/commands.h"
#include "engine/scene/plan.h"

#include <memory>
#include <vector>

namespace fathom::cloud {

// Buffers that the passes share. One copy suffices because the device runs frames one after the other. Slots
// are in patch-major order (shaders/README.md).
struct WorkBuffers {
    WorkBuffers(const gpu::Device& device, const Plan& plan, const PatchLayout& layout,
                const CameraInfo& camera);

    gpu::Buffer masks;                // uint8 per slot: class bits
    gpu::Buffer listed;               // uint per patch: kPatch bits
    gpu::Buffer list;                 // uint: patches in any order, in three parts (FrameCounters)
    gpu::Buffer counters;             // FrameCounters
    gpu::Buffer points;               // vec4 per slot
    gpu::Buffer growth;               // vec4 per sub-patch: thinning
    gpu::Buffer seen, kept, keptTime; // vec4, vec4, uint per slot: memory of points
    gpu::Buffer memoryCounts;         // uint per patch: points in memory + 65536 x held points
    gpu::Buffer estimates;            // 2 x uvec4 per slot: depths averaged over frames (estimate.comp)
    gpu::Buffer nearest;              // uint per cell of the colour image: occlusion
    gpu::Buffer rays;                 // vec2 per pixel, row-major
    gpu::Buffer radii, heldRadii; // float per slot: R [m] of the spheres around the seen and the held point;
                                  // < 0 = none. Empty with Plan::pack
    gpu::Buffer classes; // uint8 per slot: class of the seen sphere | class of the held one << 4; with
                         // Plan::pack only in patches with several classes
    gpu::Buffer depth;   // uint16 per pixel, row-major: copy of the upload; empty unless Plan::keepDepth
    // The CPU reads points, kept, both radii and classes; with Plan::pack only classes, if there are several.
    // listed and counters are cleared between frames; each set has a copy.
    gpu::Buffer unused; // bound instead of buffers that are not in the plan

    uint32_t cellEdge = 1, cellsAcross = 1, cellsDown = 1; // occlusion cells [colour pixels]

private:
    void addSpheres(const gpu::Device& device, const Plan& plan, uint64_t slots);
    void addHold(const gpu::Device& device, const Plan& plan, const PatchLayout& layout);
    void addOcclusion(const gpu::Device& device, const CameraInfo& camera);
};

// Texel formats of uploads, of points and other vec4 buffers, and of class bits.
inline constexpr VkFormat kDepthTexels = VK_FORMAT_R16_UINT;
inline constexpr VkFormat kVec4Texels = VK_FORMAT_R32G32B32A32_SFLOAT;
inline constexpr VkFormat kColourTexels = VK_FORMAT_R8G8B8A8_UINT;
inline constexpr VkFormat kMaskTexels = VK_FORMAT_R32G32B32A32_UINT; // one texel per sub-patch

// Uploads of one frame: parameters and images. Images are copied, unless the device can read them in place.
struct UploadBuffers {
    // Imports the given memory, which holds one image of the camera's size each. Throws Error when the device
    // cannot import it.
    UploadBuffers(const gpu::Device& device, const Plan& plan, const CameraInfo& camera,
                  const std::shared_ptr<const void>& depthMemory = nullptr,
                  const std::shared_ptr<const void>& colourMemory = nullptr);

    gpu::Buffer params;                       // FrameParams
    gpu::Buffer depth;                        // uint16 per pixel, row-major
    gpu::Buffer colour;                       // in the camera's format; empty when no class uses colour
    ColourFormat format = ColourFormat::Rgba; // of colour
    // vec4: links and spheres of the arm, in the format of classify.comp; empty without self-filter
    gpu::Buffer arm;
};

// Device side of one fixture set. The CPU copies from the readback buffers.
struct SetBuffers {
    SetBuffers() = default; // none
    SetBuffers(const gpu::Device& device, const Plan& plan, const PatchLayout& layout);

    gpu::Buffer packed; // words: one run per patch with its spheres (shaders/lib/packing.glsl), in any order;
                        // empty without Plan::pack
    // 16 uint per listed patch, 8 per layer: bit (layer * 256 + slot) = the slot has a sphere
    gpu::Buffer places;
    gpu::Buffer runs;  // uvec2 per listed patch: first word of its run; number of spheres + 65536 x class
                       // bits, kRunGrown, kRunWide
    gpu::Buffer bits;  // uint per sub-patch of a listed patch: bits of the pixels with a forbidden class
    gpu::Buffer nodes; // vec4 per node; empty without a tree
    gpu::Buffer nodeCounts;    // uint per node
    gpu::Buffer spheres, held; // vec4 per slot, R < 0 = none; for the GPU query, else empty
    gpu::Buffer classes;       // as WorkBuffers::classes; for the GPU query if there are several classes
    gpu::Buffer moments;       // PatchMoments, kMaxClasses per patch
    gpu::Buffer counters;      // FrameCounters
    gpu::Buffer listed;        // uint per patch
    gpu::Buffer points, masks; // copies for guidance classes that need their points
};

// One T per upload slot, created when the slot is first used.
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

// What the passes are built from. All referenced objects must outlive the passes.
struct CloudContext {
    const gpu::Device& device;
    const Plan& plan;
    const PatchLayout& layout;
    const CameraInfo& camera;
    const WorkBuffers& work;
    const std::vector<SetBuffers*>& sets;
};

} // namespace fathom::cloud
