// SPDX-License-Identifier: Apache-2.0
#include "engine/gpu/device.h"

#include "engine/gpu/physical_device.h"
#include "engine/gpu/query_crossover.h"
#include "engine/gpu/result.h"
#include "engine/types/blocked_signals.h"
#include "engine/types/error.h"
#include "engine/types/log.h"

#include <algorithm>
#include <array>

namespace fathom::gpu {

Device::Device(VkPhysicalDevice physical)
    : physical_(physical)
    , family_(*computeFamily(physical_))
    , facts_(readFacts(physical_)) {}

// Delegates, so that the destructor runs when a later step throws.
Device::Device(const Instance& instance, const std::string& selector, Drawing drawing)
    : Device(choosePhysicalDevice(instance, selector)) {
    facts_.gpuQueryLeaves = storedQueryCrossover(physical_, facts_.gpuQueryLeaves);
    vkGetPhysicalDeviceMemoryProperties(physical_, &memory_);
    if (drawing != Drawing::None) {
        chooseDrawQueue();
    }
    queryIndex_ = queueFamilies(physical_)[family_].queueCount > drawIndex_ + 1 ? drawIndex_ + 1 : 0;
    createLogicalDevice(instance.validation().gpuAssisted, drawing);
    vkGetDeviceQueue(handle_, family_, 0, &queue_);
    vkGetDeviceQueue(handle_, family_, queryIndex_, &queryQueue_);
    if (drawing != Drawing::None) {
        vkGetDeviceQueue(handle_, drawFamily_, drawIndex_, &drawQueue_);
    }
    cache_.emplace(handle_, cacheFileOf(physical_, ".pipelines"));
    log::info("device {} ({})", facts_.name, facts_.driver);
}

// Prefers a separate graphics queue: in the compute family, else in the first graphics family.
void Device::chooseDrawQueue() {
    const std::vector<VkQueueFamilyProperties> families = queueFamilies(physical_);
    const auto draws = [&](uint32_t f) { return (families[f].queueFlags & VK_QUEUE_GRAPHICS_BIT) != 0; };
    drawFamily_ = family_;
    for (uint32_t f = 0; f < families.size() && !draws(drawFamily_); ++f) {
        drawFamily_ = draws(f) ? f : drawFamily_;
    }
    if (!draws(drawFamily_)) {
        throw BadInput("device", "window", facts_.name, "a device that draws: this one only computes");
    }
    drawIndex_ = drawFamily_ == family_ && families[family_].queueCount > 1 ? 1 : 0;
}

void Device::createLogicalDevice(bool gpuAssisted, Drawing drawing) {
    const float drawIsSecond[] = {1.0f, 0.5f, 1.0f},
                noDraw[] = {1.0f, 1.0f}; // passes and queries before frames
    const float* const priorities = drawIndex_ == 1 ? drawIsSecond : noDraw;
    std::vector<VkDeviceQueueCreateInfo> queues;
    const auto add = [&](uint32_t family, uint32_t number, const float* priority) {
        VkDeviceQueueCreateInfo queue{VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO};
        queue.queueFamilyIndex = family;
        queue.queueCount = number;
        queue.pQueuePriorities = priority;
        queues.push_back(queue);
    };
    add(family_, 1 + std::max(drawIndex_, queryIndex_), priorities);
    if (drawing != Drawing::None && drawFamily_ != family_) {
        add(drawFamily_, 1, drawIsSecond + 1);
    }

    VkPhysicalDeviceVulkan12Features v12{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES};
    v12.timelineSemaphore = VK_TRUE;
    v12.hostQueryReset = VK_TRUE; // required in Vulkan 1.2
    VkPhysicalDeviceFeatures2 features{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2};
    features.pNext = &v12;
    // Only GPU-assisted validation needs these features: it writes its findings from every stage.
    features.features.fragmentStoresAndAtomics = gpuAssisted ? VK_TRUE : VK_FALSE;
    features.features.vertexPipelineStoresAndAtomics = gpuAssisted ? VK_TRUE : VK_FALSE;

    VkDeviceCreateInfo info{VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO};
    info.pNext = &features;
    info.queueCreateInfoCount = static_cast<uint32_t>(queues.size());
    info.pQueueCreateInfos = queues.data();
    const std::vector<const char*> extensions = extensionsFor(drawing);
    info.enabledExtensionCount = static_cast<uint32_t>(extensions.size());
    info.ppEnabledExtensionNames = extensions.data();
    const BlockedSignals quiet; // for threads of the driver
    VkDevice handle = VK_NULL_HANDLE;
    check(vkCreateDevice(physical_, &info, nullptr, &handle), "vkCreateDevice");
    handle_ = handle;
    if (facts_.hostPointerAlignment > 0) {
        hostPointerProperties_ = reinterpret_cast<PFN_vkGetMemoryHostPointerPropertiesEXT>(
            vkGetDeviceProcAddr(handle_, "vkGetMemoryHostPointerPropertiesEXT"));
    }
}

std::vector<const char*> Device::extensionsFor(Drawing drawing) const {
    std::vector<const char*> extensions;
    if (facts_.hostPointerAlignment > 0) {
        extensions.push_back(VK_EXT_EXTERNAL_MEMORY_HOST_EXTENSION_NAME);
    }
    if (drawing == Drawing::Surface) {
        if (!hasExtension(physical_, VK_KHR_SWAPCHAIN_EXTENSION_NAME)) {
            throw BadInput("device", "window", facts_.name,
                           "a device that can present to a display (VK_KHR_swapchain)");
        }
        extensions.push_back(VK_KHR_SWAPCHAIN_EXTENSION_NAME);
    }
    return extensions;
}

Device::~Device() {
    pipelines_.clear();
    cache_.reset();
    vkDestroyDevice(handle_, nullptr);
}

std::vector<uint32_t> memoryTypes(MemoryKind kind, const VkPhysicalDeviceMemoryProperties& memory,
                                  uint32_t typeBits) {
    constexpr VkMemoryPropertyFlags kLocal = VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT;
    constexpr VkMemoryPropertyFlags kShared =
        VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
    constexpr VkMemoryPropertyFlags kCached = VK_MEMORY_PROPERTY_HOST_CACHED_BIT;
    const auto wanted = [&]() -> std::array<VkMemoryPropertyFlags, 2> { // best first
        switch (kind) {
        case MemoryKind::Upload:
            return {kLocal | kShared, kShared};
        case MemoryKind::Readback:
            return {kShared | kCached, kShared};
        default:
            return {kLocal, 0};
        }
    }();
    std::vector<uint32_t> types;
    for (const VkMemoryPropertyFlags flags : wanted) {
        for (uint32_t t = 0; t < memory.memoryTypeCount; ++t) {
            const bool fits =
                (typeBits >> t & 1u) != 0 && (memory.memoryTypes[t].propertyFlags & flags) == flags;
            if (fits && std::ranges::find(types, t) == types.end()) {
                types.push_back(t);
            }
        }
        if (kind == MemoryKind::Device && !types.empty()) {
            break; // a pass that reads the host's memory would take far too long
        }
    }
    return types;
}

std::vector<uint32_t> Device::memoryTypes(MemoryKind kind, uint32_t typeBits) const {
    std::vector<uint32_t> types = gpu::memoryTypes(kind, memory_, typeBits);
    if (types.empty()) {
        throw Error("device " + facts_.name + " offers no memory of the kind needed");
    }
    return types;
}

uint32_t Device::hostPointerTypes(const void* memory) const {
    VkMemoryHostPointerPropertiesEXT properties{VK_STRUCTURE_TYPE_MEMORY_HOST_POINTER_PROPERTIES_EXT};
    if (hostPointerProperties_ == nullptr ||
        hostPointerProperties_(handle_, VK_EXTERNAL_MEMORY_HANDLE_TYPE_HOST_ALLOCATION_BIT_EXT, memory,
                               &properties) != VK_SUCCESS) {
        return 0;
    }
    uint32_t bits = 0;
    for (uint32_t t = 0; t < memory_.memoryTypeCount; ++t) {
        const bool coherent =
            (memory_.memoryTypes[t].propertyFlags & VK_MEMORY_PROPERTY_HOST_COHERENT_BIT) != 0;
        bits |= coherent ? properties.memoryTypeBits & 1u << t : 0u;
    }
    return bits;
}

void Device::submit(VkCommandBuffer commands, const TimelinePoint& wait, const TimelinePoint& signal) {
    const std::lock_guard lock(queueMutex_);
    submitTo(queue_, commands, wait, signal);
}

void Device::submitQuery(VkCommandBuffer commands, const TimelinePoint& wait, const TimelinePoint& signal) {
    const std::lock_guard lock(ownQueryQueue() ? queryMutex_ : queueMutex_);
    submitTo(queryQueue_, commands, wait, signal);
}

void Device::submitTo(VkQueue queue, VkCommandBuffer commands, const TimelinePoint& wait,
                      const TimelinePoint& signal) {
    VkTimelineSemaphoreSubmitInfo values{VK_STRUCTURE_TYPE_TIMELINE_SEMAPHORE_SUBMIT_INFO};
    values.waitSemaphoreValueCount = wait.value != 0 ? 1 : 0;
    values.pWaitSemaphoreValues = &wait.value;
    values.signalSemaphoreValueCount = 1;
    values.pSignalSemaphoreValues = &signal.value;
    const VkPipelineStageFlags stage = VK_PIPELINE_STAGE_ALL_COMMANDS_BIT;
    VkSubmitInfo submit{VK_STRUCTURE_TYPE_SUBMIT_INFO};
    submit.pNext = &values;
    submit.waitSemaphoreCount = values.waitSemaphoreValueCount;
    submit.pWaitSemaphores = &wait.timeline;
    submit.pWaitDstStageMask = &stage;
    submit.commandBufferCount = 1;
    submit.pCommandBuffers = &commands;
    submit.signalSemaphoreCount = 1;
    submit.pSignalSemaphores = &signal.timeline;
    check(vkQueueSubmit(queue, 1, &submit, VK_NULL_HANDLE), "vkQueueSubmit");
}

void Device::submitDrawing(const VkSubmitInfo& submit, VkFence fence) {
    const std::lock_guard lock(sharesQueue() ? queueMutex_ : drawMutex_);
    check(vkQueueSubmit(drawQueue_, 1, &submit, fence), "vkQueueSubmit");
}

VkResult Device::present(const VkPresentInfoKHR& info) {
    const std::lock_guard lock(sharesQueue() ? queueMutex_ : drawMutex_);
    return vkQueuePresentKHR(drawQueue_, &info);
}

void Device::waitForDrawing() noexcept {
    const std::lock_guard lock(sharesQueue() ? queueMutex_ : drawMutex_);
    vkQueueWaitIdle(drawQueue_);
}

std::vector<std::string> Device::list(const Instance& instance) {
    std::vector<std::string> lines;
    for (VkPhysicalDevice device : instance.physicalDevices()) {
        const DeviceFacts facts = readFacts(device);
        const std::string why = refusal(device);
        lines.push_back(facts.name + ", " + facts.driver + (why.empty() ? "" : ", refused: " + why));
    }
    return lines;
}

} // namespace fathom::gpu
