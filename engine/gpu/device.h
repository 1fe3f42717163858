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

// Memory kinds, by how the CPU uses them.
enum class MemoryKind {
    Device,   // no CPU access
    Upload,   // the CPU writes sequentially, the GPU reads; device-local if the host can map it
    Readback, // host-cached: the CPU reads it; the GPU may write to it directly
};

// Indices of the memory types of a kind among those allowed by typeBits, best first. The heap of a better one
// may be full: the part of a graphics card's memory that the host can map is often 256 MiB for all processes.
std::vector<uint32_t> memoryTypes(MemoryKind kind, const VkPhysicalDeviceMemoryProperties& memory,
                                  uint32_t typeBits);

// What a window needs in addition to compute.
enum class Drawing {
    None,
    Offscreen, // a graphics queue
    Surface,   // a graphics queue and swapchains
};

class Device {
public:
    // selector: empty = discrete, else integrated, else another kind (a virtual GPU), else CPU; a number =
    // index; otherwise part of the name. Throws BadInput, or DeviceMissing if no device would do, that lists
    // all devices, with the reasons for rejected ones.
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

    // Memory types of a kind among those allowed by typeBits, best first; throws Error when there is none.
    std::vector<uint32_t> memoryTypes(MemoryKind kind, uint32_t typeBits) const;
    // Bits of the coherent memory types that can import the host memory at `memory`; 0 = none.
    uint32_t hostPointerTypes(const void* memory) const;

    // A value of a timeline semaphore.
    struct TimelinePoint {
        VkSemaphore timeline = VK_NULL_HANDLE;
        uint64_t value = 0; // 0 = nothing to wait for
    };
    // Submits one command buffer between two values. Holds the queue's mutex during the call. Never called by
    // the haptic thread.
    void submit(VkCommandBuffer commands, const TimelinePoint& wait, const TimelinePoint& signal);
    // The same on the queue for contact queries, which does not wait for frames. It is the queue above if the
    // device has no other (ownQueryQueue() is false).
    void submitQuery(VkCommandBuffer commands, const TimelinePoint& wait, const TimelinePoint& signal);
    bool ownQueryQueue() const { return queryQueue_ != queue_; }

    // The graphics queue; null for Drawing::None. If the device has only one queue, it is also the compute
    // queue and sharesQueue() is true: drawing then yields to passes in flight.
    VkQueue drawQueue() const { return drawQueue_; }
    uint32_t drawFamily() const { return drawFamily_; }
    bool sharesQueue() const { return drawQueue_ == queue_; }
    // Serialised vkQueueSubmit and vkQueuePresentKHR on the graphics queue. The caller handles the result of
    // present().
    void submitDrawing(const VkSubmitInfo& submit, VkFence fence);
    // Calls `use` while no other thread uses the graphics queue: for a library that submits to it by itself.
    template <class Use>
    void withDrawQueue(Use&& use) {
        const std::lock_guard lock(sharesQueue() ? queueMutex_ : drawMutex_);
        use();
    }
    VkResult present(const VkPresentInfoKHR& info);
    // Waits until the graphics queue is idle, presentation included. Call before destroying objects that it
    // uses.
    void waitForDrawing() noexcept;

    // One line per physical device: name and kind, or the reason for rejecting it.
    static std::vector<std::string> list(const Instance& instance);

private:
    explicit Device(VkPhysicalDevice physical); // without a logical device
    void createLogicalDevice(bool gpuAssisted, Drawing drawing);
    std::vector<const char*> extensionsFor(Drawing drawing) const;
    static void submitTo(VkQueue queue, VkCommandBuffer commands, const TimelinePoint& wait,
                         const TimelinePoint& signal);
    void chooseDrawQueue();

    VkPhysicalDevice physical_ = VK_NULL_HANDLE;
    VkDevice handle_ = VK_NULL_HANDLE;
    VkQueue queue_ = VK_NULL_HANDLE, queryQueue_ = VK_NULL_HANDLE;
    uint32_t family_ = 0;
    VkQueue drawQueue_ = VK_NULL_HANDLE;
    uint32_t drawFamily_ = 0, drawIndex_ = 0, queryIndex_ = 0;
    std::mutex queueMutex_, drawMutex_, queryMutex_; // the last two only if the queues differ
    std::optional<PipelineCache> cache_;             // set once the device is created
    mutable PipelineStore pipelines_;                // a cache, so mutable
    VkPhysicalDeviceMemoryProperties memory_{};
    DeviceFacts facts_;
    PFN_vkGetMemoryHostPointerPropertiesEXT hostPointerProperties_ = nullptr; // null: cannot import
};

} // namespace fathom::gpu
