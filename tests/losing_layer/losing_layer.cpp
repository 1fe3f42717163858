// SPDX-License-Identifier: Apache-2.0
// A Vulkan layer that simulates the loss of a device: from some call on, the application's device returns
// VK_ERROR_DEVICE_LOST (or VK_ERROR_OUT_OF_DEVICE_MEMORY), and some later openings fail. It can also
// invalidate a window's images or surface. The tested program is unmodified, because the layer is below it.
//   FATHOM_LOSE_AT       number, from 1, of the first submission of the first device that fails
//   FATHOM_LOSE_DONE     instead: number, from 1, of the successful wait for the first device's passes after
//                        which it is lost (the semaphore that is waited for first)
//   FATHOM_LOSE_TIMES    instead: number, from 1, of the failing read of its timestamps
//   FATHOM_LOSE_FILE     instead: a file with one word. The first matching call removes it and fails: passes
//                        (submission with a timeline), drawing (other submission) and presenting lose the
//                        device; acquire-outdated and present-outdated return VK_ERROR_OUT_OF_DATE_KHR once,
//                        waiting VK_ERROR_OUT_OF_HOST_MEMORY, allocating VK_ERROR_OUT_OF_DEVICE_MEMORY;
//                        unfinished ends a wait for drawing as if its time had passed; window-used refuses a
//                        swapchain as if another had the window; surface is lost from the next presentation
//   FATHOM_LOSE_BY       "memory": out of memory instead of lost
//   FATHOM_LOSE_OPENINGS number of failed attempts to open a device after each loss
#include "tests/losing_layer/asked.h"
#include "tests/losing_layer/next_device.h"
#include "tests/losing_layer/ours.h"

#include <map>
#include <mutex>
#include <vulkan/vk_layer.h>
#include <vulkan/vulkan.h>

namespace {

using namespace losing;

std::mutex mutex;
std::map<void*, NextDevice> devices; // key: the loader's dispatch table, which queues share with their device
PFN_vkGetInstanceProcAddr nextInstance = nullptr;
PFN_vkDestroySurfaceKHR nextDestroySurface = nullptr;
long opened = 0, refused = 0; // refused: since the last loss

VKAPI_ATTR VkResult VKAPI_CALL createInstance(const VkInstanceCreateInfo* info,
                                              const VkAllocationCallbacks* memory, VkInstance* instance) {
    auto* link =
        linkOf<VkLayerInstanceCreateInfo>(info->pNext, VK_STRUCTURE_TYPE_LOADER_INSTANCE_CREATE_INFO);
    if (link == nullptr) {
        return VK_ERROR_INITIALIZATION_FAILED;
    }
    nextInstance = link->u.pLayerInfo->pfnNextGetInstanceProcAddr;
    link->u.pLayerInfo = link->u.pLayerInfo->pNext;
    const auto create =
        reinterpret_cast<PFN_vkCreateInstance>(nextInstance(VK_NULL_HANDLE, "vkCreateInstance"));
    const VkResult result = create(info, memory, instance);
    if (result == VK_SUCCESS) { // look up now: later the loader would return the topmost function, which is
                                // this layer's
        nextDestroySurface =
            reinterpret_cast<PFN_vkDestroySurfaceKHR>(nextInstance(*instance, "vkDestroySurfaceKHR"));
    }
    return result;
}

VKAPI_ATTR VkResult VKAPI_CALL createDevice(VkPhysicalDevice physical, const VkDeviceCreateInfo* info,
                                            const VkAllocationCallbacks* memory, VkDevice* device) {
    auto* link = linkOf<VkLayerDeviceCreateInfo>(info->pNext, VK_STRUCTURE_TYPE_LOADER_DEVICE_CREATE_INFO);
    const std::lock_guard lock(mutex);
    if (link == nullptr || (opened > 0 && refused++ < number("FATHOM_LOSE_OPENINGS"))) {
        return VK_ERROR_INITIALIZATION_FAILED;
    }
    const PFN_vkGetInstanceProcAddr instance = link->u.pLayerInfo->pfnNextGetInstanceProcAddr;
    const PFN_vkGetDeviceProcAddr address = link->u.pLayerInfo->pfnNextGetDeviceProcAddr;
    link->u.pLayerInfo = link->u.pLayerInfo->pNext;
    const auto create = reinterpret_cast<PFN_vkCreateDevice>(instance(VK_NULL_HANDLE, "vkCreateDevice"));
    const VkResult result = create(physical, info, memory, device);
    if (result == VK_SUCCESS) {
        NextDevice& next = devices[keyOf(*device)];
        next.handle = *device;
        next.idle = find<PFN_vkDeviceWaitIdle>(address, *device, "vkDeviceWaitIdle");
        next.address = address;
        next.destroy = find<PFN_vkDestroyDevice>(address, *device, "vkDestroyDevice");
        next.submit = find<PFN_vkQueueSubmit>(address, *device, "vkQueueSubmit");
        next.wait = find<PFN_vkWaitSemaphores>(address, *device, "vkWaitSemaphores");
        next.waitFences = find<PFN_vkWaitForFences>(address, *device, "vkWaitForFences");
        next.times = find<PFN_vkGetQueryPoolResults>(address, *device, "vkGetQueryPoolResults");
        next.present = find<PFN_vkQueuePresentKHR>(address, *device, "vkQueuePresentKHR");
        next.acquire = find<PFN_vkAcquireNextImageKHR>(address, *device, "vkAcquireNextImageKHR");
        next.createSwapchain = find<PFN_vkCreateSwapchainKHR>(address, *device, "vkCreateSwapchainKHR");
        next.allocate = find<PFN_vkAllocateMemory>(address, *device, "vkAllocateMemory");
        next.first = opened++ == 0;
    }
    return result;
}

VKAPI_ATTR void VKAPI_CALL destroyDevice(VkDevice device, const VkAllocationCallbacks* memory) {
    const std::lock_guard lock(mutex);
    void* key = keyOf(device);
    devices[key].destroy(device, memory);
    devices.erase(key);
}

// Requires the mutex. The application ensures that no other thread uses the queue.
bool loses(NextDevice& device, const char* call, bool now = false) {
    if (!device.lost && (now || askedFor(call))) {
        device.idle(device.handle); // a lost device has no running work, so its memory may be freed
        device.lost = true;
        refused = 0;
    }
    return device.lost;
}

VKAPI_ATTR VkResult VKAPI_CALL submit(VkQueue queue, uint32_t count, const VkSubmitInfo* infos,
                                      VkFence fence) {
    PFN_vkQueueSubmit pass = nullptr;
    {
        const std::lock_guard lock(mutex);
        NextDevice& device = devices[keyOf(queue)];
        const long at = number("FATHOM_LOSE_AT");
        const bool now = device.first && at > 0 && ++device.submissions >= at;
        if (loses(device, count > 0 && infos[0].pNext != nullptr ? "passes" : "drawing", now)) {
            return lossOf();
        }
        pass = device.submit;
    }
    return pass(queue, count, infos, fence);
}

// Requires the mutex, after a successful wait.
void completed(NextDevice& device, VkSemaphore semaphore) {
    device.passes = device.passes == VK_NULL_HANDLE ? semaphore : device.passes;
    const long at = number("FATHOM_LOSE_DONE");
    if (device.first && at > 0 && semaphore == device.passes && ++device.landings == at) {
        device.lost = device.working = true;
        refused = 0;
    }
}

VKAPI_ATTR VkResult VKAPI_CALL waitSemaphores(VkDevice handle, const VkSemaphoreWaitInfo* info,
                                              uint64_t timeout) {
    PFN_vkWaitSemaphores pass = nullptr;
    bool lost = false;
    {
        const std::lock_guard lock(mutex);
        const NextDevice& device = devices[keyOf(handle)];
        lost = device.lost && lossOf() == VK_ERROR_DEVICE_LOST;
        const bool starved = askedFor("waiting");
        if (starved || (lost && !device.working)) {
            return starved ? VK_ERROR_OUT_OF_HOST_MEMORY : VK_ERROR_DEVICE_LOST;
        }
        pass = device.wait;
    }
    const VkResult result = pass(handle, info, timeout);
    const std::lock_guard lock(mutex);
    if (!lost && result == VK_SUCCESS) {
        completed(devices[keyOf(handle)], info->pSemaphores[0]);
    }
    return lost ? VK_ERROR_DEVICE_LOST : result;
}

VKAPI_ATTR VkResult VKAPI_CALL waitFences(VkDevice device, uint32_t count, const VkFence* fences,
                                          VkBool32 all, uint64_t timeout) {
    PFN_vkWaitForFences pass = nullptr;
    {
        const std::lock_guard lock(mutex);
        if (devices[keyOf(device)].lost && lossOf() == VK_ERROR_DEVICE_LOST) {
            return VK_ERROR_DEVICE_LOST;
        }
        if (askedFor("unfinished")) {
            return VK_TIMEOUT;
        }
        pass = devices[keyOf(device)].waitFences;
    }
    return pass(device, count, fences, all, timeout);
}

VKAPI_ATTR VkResult VKAPI_CALL times(VkDevice handle, VkQueryPool pool, uint32_t first, uint32_t count,
                                     size_t bytes, void* data, VkDeviceSize stride,
                                     VkQueryResultFlags flags) {
    PFN_vkGetQueryPoolResults pass = nullptr;
    {
        const std::lock_guard lock(mutex);
        NextDevice& device = devices[keyOf(handle)];
        const long at = number("FATHOM_LOSE_TIMES");
        if (loses(device, "times", device.first && at > 0 && ++device.timings >= at)) {
            return lossOf();
        }
        pass = device.times;
    }
    return pass(handle, pool, first, count, bytes, data, stride, flags);
}

VKAPI_ATTR VkResult VKAPI_CALL allocate(VkDevice device, const VkMemoryAllocateInfo* info,
                                        const VkAllocationCallbacks* callbacks, VkDeviceMemory* memory) {
    PFN_vkAllocateMemory pass = nullptr;
    {
        const std::lock_guard lock(mutex);
        if (askedFor("allocating")) {
            return VK_ERROR_OUT_OF_DEVICE_MEMORY;
        }
        pass = devices[keyOf(device)].allocate;
    }
    return pass(device, info, callbacks, memory);
}

VKAPI_ATTR VkResult VKAPI_CALL present(VkQueue queue, const VkPresentInfoKHR* info) {
    PFN_vkQueuePresentKHR pass = nullptr;
    VkResult after = VK_SUCCESS; // the wait on the frame's semaphores counts in any case
    {
        const std::lock_guard lock(mutex);
        if (loses(devices[keyOf(queue)], "presenting")) {
            return lossOf();
        }
        pass = devices[keyOf(queue)].present;
        if (askedFor("surface")) {
            loseSurface();
            after = VK_ERROR_SURFACE_LOST_KHR;
        } else if (askedFor("present-outdated")) {
            after = VK_ERROR_OUT_OF_DATE_KHR;
        }
    }
    const VkResult result = pass(queue, info);
    return after == VK_SUCCESS ? result : after;
}

VKAPI_ATTR VkResult VKAPI_CALL acquire(VkDevice device, VkSwapchainKHR swapchain, uint64_t timeout,
                                       VkSemaphore semaphore, VkFence fence, uint32_t* index) {
    PFN_vkAcquireNextImageKHR pass = nullptr;
    {
        const std::lock_guard lock(mutex);
        if (devices[keyOf(device)].lost) {
            return lossOf();
        }
        if (askedFor("acquire-outdated")) {
            return VK_ERROR_OUT_OF_DATE_KHR;
        }
        pass = devices[keyOf(device)].acquire;
    }
    return pass(device, swapchain, timeout, semaphore, fence, index);
}

VKAPI_ATTR VkResult VKAPI_CALL createSwapchain(VkDevice device, const VkSwapchainCreateInfoKHR* info,
                                               const VkAllocationCallbacks* memory,
                                               VkSwapchainKHR* swapchain) {
    const std::lock_guard lock(mutex);
    if (const VkResult refusal = refusalOf(info->surface); refusal != VK_SUCCESS) {
        return refusal;
    }
    hasImages(info->surface);
    return devices[keyOf(device)].createSwapchain(device, info, memory, swapchain);
}

VKAPI_ATTR void VKAPI_CALL destroySurface(VkInstance instance, VkSurfaceKHR surface,
                                          const VkAllocationCallbacks* memory) {
    const std::lock_guard lock(mutex);
    forget(surface);
    nextDestroySurface(instance, surface, memory);
}

template <class Call>
PFN_vkVoidFunction plain(Call call) {
    return reinterpret_cast<PFN_vkVoidFunction>(call);
}

VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL deviceAddress(VkDevice device, const char* name) {
    const auto always = among({{"vkGetDeviceProcAddr", plain(deviceAddress)},
                               {"vkDestroyDevice", plain(destroyDevice)},
                               {"vkWaitSemaphores", plain(waitSemaphores)},
                               {"vkQueueSubmit", plain(submit)},
                               {"vkWaitForFences", plain(waitFences)},
                               {"vkGetQueryPoolResults", plain(times)},
                               {"vkAllocateMemory", plain(allocate)}},
                              name);
    if (always != nullptr) {
        return always;
    }
    const std::lock_guard lock(mutex);
    const NextDevice& next = devices[keyOf(device)];
    const auto there = [](const void* below, PFN_vkVoidFunction call) { return below ? call : nullptr; };
    const auto shown =
        among({{"vkQueuePresentKHR", there(reinterpret_cast<void*>(next.present), plain(present))},
               {"vkAcquireNextImageKHR", there(reinterpret_cast<void*>(next.acquire), plain(acquire))},
               {"vkCreateSwapchainKHR",
                there(reinterpret_cast<void*>(next.createSwapchain), plain(createSwapchain))}},
              name);
    return shown != nullptr ? shown : next.address(device, name);
}

VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL instanceAddress(VkInstance instance, const char* name) {
    const auto ours = among({{"vkGetInstanceProcAddr", plain(instanceAddress)},
                             {"vkCreateInstance", plain(createInstance)},
                             {"vkCreateDevice", plain(createDevice)},
                             {"vkGetDeviceProcAddr", plain(deviceAddress)},
                             {"vkDestroySurfaceKHR", plain(destroySurface)}},
                            name);
    return ours != nullptr || nextInstance == nullptr ? ours : nextInstance(instance, name);
}

} // namespace

extern "C" __attribute__((visibility("default"))) VKAPI_ATTR VkResult VKAPI_CALL
vkNegotiateLoaderLayerInterfaceVersion(VkNegotiateLayerInterface* version) {
    version->loaderLayerInterfaceVersion = 2;
    version->pfnGetInstanceProcAddr = instanceAddress;
    version->pfnGetDeviceProcAddr = deviceAddress;
    version->pfnGetPhysicalDeviceProcAddr = nullptr;
    return VK_SUCCESS;
}
