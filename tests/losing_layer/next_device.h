// SPDX-License-Identifier: Apache-2.0
// A device of the application, as the layer sees it: the functions of the layer below, and whether it is
// lost.
#pragma once

#include <vulkan/vulkan.h>

namespace losing {

struct NextDevice {
    VkDevice handle = VK_NULL_HANDLE;
    PFN_vkDeviceWaitIdle idle = nullptr;
    PFN_vkGetDeviceProcAddr address = nullptr;
    PFN_vkDestroyDevice destroy = nullptr;
    PFN_vkQueueSubmit submit = nullptr;
    PFN_vkWaitSemaphores wait = nullptr;
    PFN_vkWaitForFences waitFences = nullptr;
    PFN_vkGetQueryPoolResults times = nullptr;
    PFN_vkAllocateMemory allocate = nullptr;
    PFN_vkQueuePresentKHR present = nullptr; // null: no swapchains
    PFN_vkAcquireNextImageKHR acquire = nullptr;
    PFN_vkCreateSwapchainKHR createSwapchain = nullptr;
    bool first = false, lost = false;
    bool working = false; // lost while other threads' submissions may still run
    VkSemaphore passes = VK_NULL_HANDLE;
    long submissions = 0, timings = 0, landings = 0;
};

} // namespace losing
