// SPDX-License-Identifier: Apache-2.0
// The window's images, made again when the window changes its size or loses them.
#pragma once

#include "engine/gpu/device.h"

#include <vector>

namespace fathom::operate {

// The surface is the caller's and outlives this, or leave() comes before its end. Thread: the window's.
class Swapchain {
public:
    // Throws Error when the device cannot show pictures on this surface.
    Swapchain(gpu::Device& device, VkSurfaceKHR surface);
    ~Swapchain();
    Swapchain(const Swapchain&) = delete;
    Swapchain& operator=(const Swapchain&) = delete;

    // Makes the images anew for a window of this size; false when there is nothing to show (minimised).
    bool fit(VkExtent2D wanted);
    void lose() { lost_ = true; } // the next fit() makes new ones
    // After a call that says so the surface can show nothing any more: leave() it, and go on with another.
    bool surfaceLost() const { return surfaceLost_; }
    void leave();                   // nothing is on the surface after it
    void moveTo(VkSurfaceKHR next); // throws as the constructor
    // The next image to fill, or null when there is none in time or the images are lost; `ready` is
    // signalled.
    VkImage acquire(VkSemaphore ready);
    VkSemaphore filled() const { return filled_[index_]; } // to be signalled before show()
    void show();

    VkExtent2D size() const { return size_; }
    VkFormat format() const { return format_.format; } // of the images
    uint32_t remade() const { return remade_; }        // times that fit() made images

private:
    bool good(VkResult result, const char* call); // false: images or surface are lost
    void destroyImages();
    bool create(const VkSurfaceCapabilitiesKHR& can, VkExtent2D size); // false: as good()

    gpu::Device& device_;
    VkSurfaceKHR surface_;
    VkSwapchainKHR handle_ = VK_NULL_HANDLE;
    VkSurfaceFormatKHR format_{};
    VkExtent2D size_{};
    std::vector<VkImage> images_;
    std::vector<VkSemaphore> filled_; // one an image
    uint32_t index_ = 0, remade_ = 0;
    bool lost_ = true, surfaceLost_ = false;
};

} // namespace fathom::operate
