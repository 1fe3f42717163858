// SPDX-License-Identifier: Apache-2.0
// Pipelines that were compiled on a device, kept for whoever asks for the same again: a scene that is edited
// makes its passes anew, and most of them are as they were. A driver's own cache may keep less (llvmpipe's
// works through the SPIR-V each time).
#pragma once

#include <cstdint>
#include <memory>
#include <mutex>
#include <utility>
#include <vector>
#include <vulkan/vulkan.h>

namespace fathom::gpu {

// What of a pipeline its code depends on.
struct PipelineKey {
    const uint32_t* spirv = nullptr; // by its place: shaders are constants of the program
    size_t words = 0;
    uint32_t bindings = 0, pushBytes = 0;
    bool uniform = false;
    std::vector<uint32_t> constants;
    std::vector<std::pair<uint32_t, VkFormat>> texels;

    bool operator==(const PipelineKey&) const = default;
};

// Destroyed before its device.
struct CompiledPipeline {
    explicit CompiledPipeline(VkDevice owner)
        : device(owner) {}
    ~CompiledPipeline();
    CompiledPipeline(const CompiledPipeline&) = delete;
    CompiledPipeline& operator=(const CompiledPipeline&) = delete;

    VkDevice device;
    VkPipeline handle = VK_NULL_HANDLE;
    VkPipelineLayout layout = VK_NULL_HANDLE;
    VkDescriptorSetLayout setLayout = VK_NULL_HANDLE;
};

// Thread: any.
class PipelineStore {
public:
    static constexpr size_t kMost = 48; // beyond, those go that nobody uses, the longest unused first

    std::shared_ptr<const CompiledPipeline> find(const PipelineKey& key); // null: there is none
    // When two threads compiled the same, the first stays: use what is returned.
    std::shared_ptr<const CompiledPipeline> keep(PipelineKey key,
                                                 std::shared_ptr<const CompiledPipeline> compiled);
    size_t size() const;
    void clear(); // before the device goes

private:
    struct Entry {
        PipelineKey key;
        std::shared_ptr<const CompiledPipeline> compiled;
    };
    std::shared_ptr<const CompiledPipeline> findHeld(const PipelineKey& key);

    mutable std::mutex mutex_;
    std::vector<Entry> entries_; // the longest unused first
};

} // namespace fathom::gpu
