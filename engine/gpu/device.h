// SPDX-License-Identifier: Apache-2.0
// One logical device with one compute queue, and its properties.
#pragma once

#include "engine/gpu/instance.h"
#include "engine/gpu/pipeline_cache.h"
#include "engine/gpu/pipeline_store.h"
#include "engine/types/device_facts.h"

#include <mutex>
#include <optional>
#include <string>
#include <vector>

namespace fathom::gpu {

// Memory of a buffer, by how the CPU uses it.
enum class MemoryKind {
    Device,   // the CPU never touches it
    Upload,   // the CPU writes it in order, the GPU reads it; device-local when the host can see that
    Readback, // host-cached: the CPU reads it; the GPU may write it straight
};

// What a window needs beside compute.
enum class Drawing {
    None,
    Offscreen, // a queue that draws
    Surface,   // the same, and swapchains
};

class Device {
public:
    // selector: empty = discrete, else integrated, else CPU; a number = index; otherwise part of the name.
    // Throws BadInput listing what there is, each with the reason when refused.
    Device(const Instance& instance, const std::string& selector = {}, Drawing drawing = Drawing::None);
    ~Device();
    Device(const Device&) = delete;
    Device& operator=(const Device&) = delete;

    VkDevice handle() const { return handle_; }
    VkPhysicalDevice physical() const { return physical_; }
    const DeviceFacts& facts() const { return facts_; }
    VkPipelineCache pipelineCache() const { return cache_->handle(); }
    PipelineStore& pipelines() const { return pipelines_; }
    uint32_t queueFamily() const { return family_; }

    // Memory type of a kind among those allowed by typeBits; throws Error when there is none.
    uint32_t memoryType(MemoryKind kind, uint32_t typeBits) const;
    // Bits of the coherent memory types as which the host's memory at `memory` can be imported; 0 = it
    // cannot.
    uint32_t hostPointerTypes(const void* memory) const;

    // Submits one command buffer; waits for waitValue of the timeline when not 0 and signals signalValue. The
    // mutex of the queue is held for the call only. Never called by the haptic thread.
    void submit(VkCommandBuffer commands, VkSemaphore timeline, uint64_t waitValue, uint64_t signalValue);

    // The queue that draws; null when Drawing::None. Where the device has one queue only it is the one that
    // computes, and sharesQueue() is true: then whoever draws yields to passes in flight.
    VkQueue drawQueue() const { return drawQueue_; }
    uint32_t drawFamily() const { return drawFamily_; }
    bool sharesQueue() const { return drawQueue_ == queue_; }
    // vkQueueSubmit and vkQueuePresentKHR on that queue, one at a time. The result of present() is the
    // caller's to judge.
    void submitDrawing(const VkSubmitInfo& submit, VkFence fence);
    VkResult present(const VkPresentInfoKHR& info);
    // Waits until that queue is idle, presentation included; call before destroying what it uses.
    void waitForDrawing() noexcept;

    // One line for each physical device: name, kind, or the reason for refusing it.
    static std::vector<std::string> list(const Instance& instance);

private:
    void createLogicalDevice(bool gpuAssisted, Drawing drawing);
    std::vector<const char*> extensionsFor(Drawing drawing) const;
    void chooseDrawQueue();

    VkPhysicalDevice physical_ = VK_NULL_HANDLE;
    VkDevice handle_ = VK_NULL_HANDLE;
    VkQueue queue_ = VK_NULL_HANDLE;
    uint32_t family_ = 0;
    VkQueue drawQueue_ = VK_NULL_HANDLE;
    uint32_t drawFamily_ = 0, drawIndex_ = 0;
    std::mutex queueMutex_, drawMutex_;  // the second one only where the queues differ
    std::optional<PipelineCache> cache_; // always, once the device is made
    mutable PipelineStore pipelines_;    // what is kept changes nothing of the device
    VkPhysicalDeviceMemoryProperties memory_{};
    DeviceFacts facts_;
    PFN_vkGetMemoryHostPointerPropertiesEXT hostPointerProperties_ = nullptr; // null: nothing is imported
};

} // namespace fathom::gpu
