// SPDX-License-Identifier: Apache-2.0
// Keeps a device's compiled pipelines for reuse: an edited scene rebuilds all passes, though most are
// unchanged. A driver's own cache may save less (llvmpipe processes the SPIR-V each time).
#pragma once

#include <cstdint>
#include <memory>
#include <mutex>
#include <span>
#include <vector>
#include <vulkan/vulkan.h>

namespace fathom::gpu {

// One buffer binding. Texel buffers are read by texelFetch. On a CPU device that is one vector gather,
// whereas storage buffers are read lane by lane.
struct BindingKind {
    VkDescriptorType type = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
    // for texel buffers; a format that every device supports in buffers
    VkFormat texels = VK_FORMAT_UNDEFINED;
    bool operator==(const BindingKind&) const = default;
};
inline constexpr BindingKind kStorage{},         // a storage buffer
    kUniform{VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER}; // a uniform buffer

// Value of a specialisation constant; ids are in shaders/shared/constants.h.
struct Constant {
    uint32_t id, value;
    bool operator==(const Constant&) const = default;
};

// The input of a pipeline.
struct PipelineInfo {
    const char* name;                  // appears in messages and traces
    std::span<const uint32_t> spirv;   // must outlive the device
    std::vector<BindingKind> bindings; // 0..n-1
    std::vector<Constant> constants;
    uint32_t pushBytes = 0; // <= 128

    bool sameCode(const PipelineInfo& other) const {
        return spirv.data() == other.spirv.data() && bindings == other.bindings &&
               constants == other.constants && pushBytes == other.pushBytes;
    }
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
    static constexpr size_t kMax = 48; // beyond that, only pipelines in use are kept

    std::shared_ptr<const CompiledPipeline> find(const PipelineInfo& info); // null: not compiled yet
    // Adds a pipeline and returns the one to use: the first, if two threads compiled the same code.
    std::shared_ptr<const CompiledPipeline> keep(PipelineInfo info,
                                                 std::shared_ptr<const CompiledPipeline> compiled);
    size_t size() const;
    void clear(); // before the device is destroyed

private:
    struct Entry {
        PipelineInfo info;
        std::shared_ptr<const CompiledPipeline> compiled;
    };
    std::shared_ptr<const CompiledPipeline> findLocked(const PipelineInfo& info);

    mutable std::mutex mutex_;
    std::vector<Entry> entries_; // least recently used first
};

} // namespace fathom::gpu
