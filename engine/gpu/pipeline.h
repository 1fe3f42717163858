// SPDX-License-Identifier: Apache-2.0
// A compute pipeline whose bindings are buffers 0..n-1, and the descriptor sets that fill them.
#pragma once

#include "engine/gpu/buffer.h"

#include <initializer_list>
#include <span>
#include <string>
#include <vector>

namespace fathom::gpu {

// A binding that is read by texelFetch. On a CPU device that is one vector gather where a storage buffer is
// read lane by lane.
struct Texels {
    uint32_t binding;
    VkFormat format; // one that every device can fetch from a buffer
};

// What a pipeline is made from. Views: what they point at outlives the constructor's call, spirv the device.
struct PipelineInfo {
    const char* name;                // shows in messages and traces
    std::span<const uint32_t> spirv; // outlives the device
    uint32_t bindings = 0;           // buffers 0..n-1
    bool uniform = true;    // buffer 0 is a uniform buffer (parameters), the others are storage buffers
    uint32_t pushBytes = 0; // <= 128
    std::span<const uint32_t> constants; // specialisation constants 0..n-1; 0 = local_size_x
    std::initializer_list<Texels> texels = {};
};

// Compiled once a device: pipelines of the same code share what was compiled (pipeline_store.h).
class Pipeline {
public:
    Pipeline(const Device& device, const PipelineInfo& info);
    Pipeline(const Pipeline&) = delete;
    Pipeline& operator=(const Pipeline&) = delete;

    VkPipeline handle() const { return compiled_->handle; }
    VkPipelineLayout layout() const { return compiled_->layout; }
    VkDescriptorSetLayout setLayout() const { return compiled_->setLayout; }
    uint32_t bindings() const { return bindings_; }
    VkDescriptorType typeOf(uint32_t binding) const { return types_[binding]; }
    VkFormat texelsOf(uint32_t binding) const { return formats_[binding]; } // undefined: no texels
    uint32_t pushBytes() const { return pushBytes_; }
    uint32_t groupSize() const { return groupSize_; }
    const std::string& name() const { return name_; }

private:
    std::shared_ptr<const CompiledPipeline> compiled_;
    uint32_t bindings_ = 0, pushBytes_ = 0, groupSize_ = 1;
    std::vector<VkDescriptorType> types_;
    std::vector<VkFormat> formats_;
    std::string name_;
};

// One descriptor set of a pipeline, filled once. Null entries are taken by `unused`, a buffer that no shader
// variant in force reads. Move-only.
class Bindings {
public:
    Bindings() = default;
    Bindings(const Device& device, const Pipeline& pipeline, std::initializer_list<const Buffer*> buffers,
             const Buffer& unused);
    ~Bindings();
    Bindings(Bindings&& other) noexcept { swap(other); }
    Bindings& operator=(Bindings&& other) noexcept {
        swap(other);
        return *this;
    }

    VkDescriptorSet handle() const { return set_; }

private:
    VkBufferView viewOf(const Buffer& buffer, VkFormat format);
    void swap(Bindings& other) noexcept;

    const Device* device_ = nullptr;
    VkDescriptorPool pool_ = VK_NULL_HANDLE;
    VkDescriptorSet set_ = VK_NULL_HANDLE;
    std::vector<VkBufferView> views_;
};

} // namespace fathom::gpu
