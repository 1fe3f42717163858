// SPDX-License-Identifier: Apache-2.0
// A compute pipeline with buffers at bindings 0..n-1, and its descriptor sets.
#pragma once

#include "engine/gpu/buffer.h"

#include <vector>

namespace fathom::gpu {

// Compiled once per device: pipelines with the same code and constants share the compiled object
// (pipeline_store.h).
class Pipeline {
public:
    Pipeline(const Device& device, PipelineInfo info);

    VkPipeline handle() const { return compiled_->handle; }
    VkPipelineLayout layout() const { return compiled_->layout; }
    VkDescriptorSetLayout setLayout() const { return compiled_->setLayout; }
    const std::vector<BindingKind>& bindings() const { return info_.bindings; }
    uint32_t pushBytes() const { return info_.pushBytes; }
    const char* name() const { return info_.name; }

private:
    PipelineInfo info_;
    std::shared_ptr<const CompiledPipeline> compiled_;
};

// Why a device cannot read a buffer of this size as texels of this format; empty if it can.
std::string texelRefusal(const DeviceFacts& facts, uint64_t bytes, VkFormat format);

// One descriptor set of a pipeline, written once. `unused` replaces null and empty buffers, which the shader
// does not access with these constants. Move-only.
class Bindings {
public:
    Bindings() = default;
    Bindings(const Device& device, const Pipeline& pipeline, const std::vector<const Buffer*>& buffers,
             const Buffer& unused);
    ~Bindings();
    Bindings(Bindings&& other) noexcept { swap(other); }
    Bindings& operator=(Bindings&& other) noexcept {
        swap(other);
        return *this;
    }

    VkDescriptorSet handle() const { return set_; }

private:
    void write(const Pipeline& pipeline, const std::vector<const Buffer*>& buffers, const Buffer& unused);
    VkBufferView viewOf(const Buffer& buffer, VkFormat format, const char* pass);
    void swap(Bindings& other) noexcept;

    const Device* device_ = nullptr;
    VkDescriptorPool pool_ = VK_NULL_HANDLE;
    VkDescriptorSet set_ = VK_NULL_HANDLE;
    std::vector<VkBufferView> views_;
};

} // namespace fathom::gpu
