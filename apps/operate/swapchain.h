// SPDX-License-Identifier: Apache-2.0
// The swapchain of the window, recreated when the window changes size or loses it.
#pragma once

#include "engine/gpu/device.h"

#include <vector>

namespace fathom::operate {

// The caller owns the surface, which outlives this unless leave() is called first. Window thread.
class Swapchain {
public:
    // Throws Error when the device cannot present on this surface.
    Swapchain(gpu::Device& device, VkSurfaceKHR surface);
    ~Swapchain();
    Swapchain(const Swapchain&) = delete;
    Swapchain& operator=(const Swapchain&) = delete;

    // Recreates the images for a window of this size when needed; false when it is minimised.
    bool fit(VkExtent2D wanted);
    void lose() { lost_ = true; } // the next fit() recreates the images
    // The surface is lost: call leave(), then moveTo() with a new one.
    bool surfaceLost() const { return surfaceLost_; }
    void leave();                   // destroys everything on the surface
    void moveTo(VkSurfaceKHR next); // throws like the constructor
    // Returns the next image to draw to, and signals `ready`; null on a timeout or when the images are lost.
    VkImage acquire(VkSemaphore ready);
    VkSemaphore filled() const { return filled_[index_]; } // must be signalled before show()
    void show();

    VkExtent2D size() const { return size_; }
    VkFormat format() const { return format_.format; } // format of the images
    uint32_t remade() const { return remade_; }        // number of times that fit() recreated the images

private:
    bool good(VkResult result, const char* call); // false: images or surface are lost
    void destroyImages();
    bool create(const VkSurfaceCapabilitiesKHR& can, VkExtent2D size); // false: like good()

    gpu::Device& device_;
    VkSurfaceKHR surface_;
    VkSwapchainKHR handle_ = VK_NULL_HANDLE;
    VkSurfaceFormatKHR format_{};
    VkExtent2D size_{};
    VkExtent2D requested_{}; // size that the newest swapchain was made for; the surface may limit it
    std::vector<VkImage> images_;
    std::vector<VkSemaphore> filled_; // one per image
    uint32_t index_ = 0, remade_ = 0;
    bool lost_ = true, surfaceLost_ = false;
};

} // namespace fathom::operate
