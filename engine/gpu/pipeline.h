// SPDX-License-Identifier: Apache-2.0
// A compute pipeline whose bindings are buffers 0..n-1, and the descriptor sets that fill them.
#pragma once

#include "engine/gpu/buffer.h"

#include <initializer_list>
#include <span>
#include <string>

namespace fathom::gpu {

struct PipelineInfo {
    const char* name; // shows in messages and traces
    std::span<const uint32_t> spirv;
    uint32_t bindings = 0;  // buffers 0..n-1
    bool uniform = true;    // buffer 0 is a uniform buffer (parameters), the others are storage buffers
    uint32_t pushBytes = 0; // <= 128
    std::span<const uint32_t> constants; // specialisation constants 0..n-1; 0 = local_size_x
};

class Pipeline {
public:
    Pipeline(const Device& device, const PipelineInfo& info);
    ~Pipeline();
    Pipeline(const Pipeline&) = delete;
    Pipeline& operator=(const Pipeline&) = delete;

    VkPipeline handle() const { return handle_; }
    VkPipelineLayout layout() const { return layout_; }
    VkDescriptorSetLayout setLayout() const { return setLayout_; }
    uint32_t bindings() const { return bindings_; }
    bool uniform() const { return uniform_; } // binding 0 is a uniform buffer
    uint32_t pushBytes() const { return pushBytes_; }
    uint32_t groupSize() const { return groupSize_; }
    const std::string& name() const { return name_; }

private:
    const Device& device_;
    VkPipeline handle_ = VK_NULL_HANDLE;
    VkPipelineLayout layout_ = VK_NULL_HANDLE;
    VkDescriptorSetLayout setLayout_ = VK_NULL_HANDLE;
    uint32_t bindings_ = 0, pushBytes_ = 0, groupSize_ = 1;
    bool uniform_ = true;
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
    void swap(Bindings& other) noexcept;

    const Device* device_ = nullptr;
    VkDescriptorPool pool_ = VK_NULL_HANDLE;
    VkDescriptorSet set_ = VK_NULL_HANDLE;
};

} // namespace fathom::gpu
