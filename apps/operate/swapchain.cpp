// SPDX-License-Identifier: Apache-2.0
#include "apps/operate/swapchain.h"

#include "apps/operate/surface_choices.h"
#include "engine/gpu/result.h"
#include "engine/types/error.h"

#include <algorithm>

namespace fathom::operate {

using gpu::check;

namespace {

VkSurfaceFormatKHR formatFor(VkPhysicalDevice device, VkSurfaceKHR surface) {
    uint32_t count = 0;
    check(vkGetPhysicalDeviceSurfaceFormatsKHR(device, surface, &count, nullptr), "surface formats");
    std::vector<VkSurfaceFormatKHR> formats(count);
    check(vkGetPhysicalDeviceSurfaceFormatsKHR(device, surface, &count, formats.data()), "surface formats");
    const auto format = chooseFormat(formats, [&](VkFormat f) {
        VkFormatProperties can;
        vkGetPhysicalDeviceFormatProperties(device, f, &can);
        return (can.optimalTilingFeatures & VK_FORMAT_FEATURE_BLIT_DST_BIT) != 0;
    });
    if (!format) {
        throw Error("the window's surface offers no format of 8 or 10 bits per channel that this device can "
                    "copy to");
    }
    return *format;
}

VkPresentModeKHR modeFor(const gpu::Device& device, VkSurfaceKHR surface) {
    uint32_t count = 0;
    check(vkGetPhysicalDeviceSurfacePresentModesKHR(device.physical(), surface, &count, nullptr),
          "present modes");
    std::vector<VkPresentModeKHR> modes(count);
    check(vkGetPhysicalDeviceSurfacePresentModesKHR(device.physical(), surface, &count, modes.data()),
          "present modes");
    return chooseMode(modes, device.facts().kind, device.sharesQueue());
}

} // namespace

Swapchain::Swapchain(gpu::Device& device, VkSurfaceKHR surface)
    : device_(device) {
    moveTo(surface);
}

Swapchain::~Swapchain() {
    leave();
}

void Swapchain::moveTo(VkSurfaceKHR next) {
    VkBool32 shows = VK_FALSE;
    check(vkGetPhysicalDeviceSurfaceSupportKHR(device_.physical(), device_.drawFamily(), next, &shows),
          "vkGetPhysicalDeviceSurfaceSupportKHR");
    if (shows == VK_FALSE) {
        throw Error("device " + device_.facts().name + " cannot present to this window");
    }
    format_ = formatFor(device_.physical(), next);
    surface_ = next;
    surfaceLost_ = false;
}

void Swapchain::leave() {
    destroyImages();
    vkDestroySwapchainKHR(device_.handle(), handle_, nullptr);
    handle_ = VK_NULL_HANDLE;
    lost_ = true;
}

bool Swapchain::good(VkResult result, const char* call) {
    if (result == VK_ERROR_OUT_OF_DATE_KHR || result == VK_ERROR_SURFACE_LOST_KHR) {
        lost_ = true;
        surfaceLost_ = surfaceLost_ || result == VK_ERROR_SURFACE_LOST_KHR;
        return false;
    }
    check(result, call);
    return true;
}

void Swapchain::destroyImages() {
    device_.waitForDrawing(); // waits for pending presents, which still use their semaphores
    for (VkSemaphore semaphore : filled_) {
        vkDestroySemaphore(device_.handle(), semaphore, nullptr);
    }
    filled_.clear();
    images_.clear();
}

bool Swapchain::fit(VkExtent2D wanted) {
    if (wanted.width == 0 || wanted.height == 0) {
        return false;
    }
    if (!lost_ && wanted.width == requested_.width && wanted.height == requested_.height) {
        return true;
    }
    VkSurfaceCapabilitiesKHR can;
    if (!good(vkGetPhysicalDeviceSurfaceCapabilitiesKHR(device_.physical(), surface_, &can),
              "surface capabilities")) {
        return false;
    }
    const VkExtent2D size = chooseSize(can, wanted);
    if (size.width == 0 || size.height == 0) {
        return false;
    }
    if ((can.supportedUsageFlags & VK_IMAGE_USAGE_TRANSFER_DST_BIT) == 0) {
        throw Error("the window's images cannot be copied to");
    }
    requested_ = wanted;
    return create(can, size);
}

bool Swapchain::create(const VkSurfaceCapabilitiesKHR& can, VkExtent2D size) {
    VkSwapchainCreateInfoKHR info{VK_STRUCTURE_TYPE_SWAPCHAIN_CREATE_INFO_KHR};
    info.surface = surface_;
    info.minImageCount = can.minImageCount + 1;
    info.minImageCount =
        can.maxImageCount != 0 ? std::min(info.minImageCount, can.maxImageCount) : info.minImageCount;
    info.imageFormat = format_.format;
    info.imageColorSpace = format_.colorSpace;
    info.imageExtent = size;
    info.imageArrayLayers = 1;
    info.imageUsage = VK_IMAGE_USAGE_TRANSFER_DST_BIT;
    info.preTransform = can.currentTransform;
    info.compositeAlpha = chooseAlpha(can.supportedCompositeAlpha);
    info.presentMode = modeFor(device_, surface_);
    info.clipped = VK_TRUE;
    info.oldSwapchain = handle_;
    destroyImages();
    const VkSwapchainKHR old = handle_;
    handle_ = VK_NULL_HANDLE;
    const VkResult made = vkCreateSwapchainKHR(device_.handle(), &info, nullptr, &handle_);
    vkDestroySwapchainKHR(device_.handle(), old, nullptr);
    if (!good(made, "vkCreateSwapchainKHR")) {
        return false;
    }
    uint32_t count = 0;
    check(vkGetSwapchainImagesKHR(device_.handle(), handle_, &count, nullptr), "vkGetSwapchainImagesKHR");
    images_.resize(count);
    check(vkGetSwapchainImagesKHR(device_.handle(), handle_, &count, images_.data()),
          "vkGetSwapchainImagesKHR");
    filled_.resize(count);
    const VkSemaphoreCreateInfo semaphore{VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO};
    for (VkSemaphore& s : filled_) {
        check(vkCreateSemaphore(device_.handle(), &semaphore, nullptr, &s), "vkCreateSemaphore");
    }
    size_ = size;
    lost_ = false;
    ++remade_;
    return true;
}

VkImage Swapchain::acquire(VkSemaphore ready) {
    constexpr uint64_t kPatience = 5'000'000; // [ns]
    const VkResult result =
        vkAcquireNextImageKHR(device_.handle(), handle_, kPatience, ready, VK_NULL_HANDLE, &index_);
    if (result == VK_NOT_READY || result == VK_TIMEOUT) {
        return VK_NULL_HANDLE;
    }
    // A suboptimal image can still be drawn to.
    return good(result, "vkAcquireNextImageKHR") ? images_[index_] : VK_NULL_HANDLE;
}

void Swapchain::show() {
    VkPresentInfoKHR info{VK_STRUCTURE_TYPE_PRESENT_INFO_KHR};
    info.waitSemaphoreCount = 1;
    info.pWaitSemaphores = &filled_[index_];
    info.swapchainCount = 1;
    info.pSwapchains = &handle_;
    info.pImageIndices = &index_;
    const VkResult result = device_.present(info);
    lost_ = lost_ || result == VK_SUBOPTIMAL_KHR;
    good(result, "vkQueuePresentKHR");
}

} // namespace fathom::operate
