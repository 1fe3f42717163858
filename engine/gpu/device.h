// SPDX-License-Identifier: Apache-2.0
// One logical device with one compute queue, and what was discovered of it.
#pragma once

#include "engine/gpu/instance.h"
#include "engine/types/device_facts.h"

#include <mutex>
#include <string>
#include <vector>

namespace fathom::gpu {

// Where a buffer lives, by what the CPU does with it.
enum class MemoryKind {
    Device,   // the CPU never touches it
    Upload,   // the CPU writes it in order, the GPU reads it; device-local when the host can see that
    Readback, // host-cached: the CPU reads it; the GPU may write it straight
};

class Device {
public:
    // selector: empty = discrete, else integrated, else CPU; a number = index; otherwise part of the name.
    // Throws BadInput listing what there is, each with the reason when refused.
    Device(const Instance& instance, const std::string& selector = {});
    ~Device();
    Device(const Device&) = delete;
    Device& operator=(const Device&) = delete;

    VkDevice handle() const { return handle_; }
    VkPhysicalDevice physical() const { return physical_; }
    const DeviceFacts& facts() const { return facts_; }
    VkPipelineCache pipelineCache() const { return cache_; }
    uint32_t queueFamily() const { return family_; }

    // Memory type of a kind among those allowed by typeBits; throws Error when there is none.
    uint32_t memoryType(MemoryKind kind, uint32_t typeBits) const;

    // Submits one command buffer; waits for waitValue of the timeline when not 0 and signals signalValue. The
    // mutex of the queue is held for the call only. Never called by the haptic thread.
    void submit(VkCommandBuffer commands, VkSemaphore timeline, uint64_t waitValue, uint64_t signalValue);

    // One line for each physical device: name, kind, or the reason for refusing it.
    static std::vector<std::string> list(const Instance& instance);

private:
    void createLogicalDevice(bool gpuAssisted);
    void loadPipelineCache();
    void savePipelineCache() const noexcept;

    VkPhysicalDevice physical_ = VK_NULL_HANDLE;
    VkDevice handle_ = VK_NULL_HANDLE;
    VkQueue queue_ = VK_NULL_HANDLE;
    uint32_t family_ = 0;
    std::mutex queueMutex_;
    VkPipelineCache cache_ = VK_NULL_HANDLE;
    VkPhysicalDeviceMemoryProperties memory_{};
    DeviceFacts facts_;
    std::string cacheFile_;
};

} // namespace fathom::gpu
