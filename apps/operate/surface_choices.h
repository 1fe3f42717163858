// SPDX-License-Identifier: Apache-2.0
// Choices of the swapchain among what a surface offers.
#pragma once

#include "engine/types/device_facts.h"

#include <functional>
#include <optional>
#include <span>
#include <vulkan/vulkan.h>

namespace fathom::operate {

// The images already contain display values: any format without sRGB conversion is right, of 8 bits per
// channel if there is one, else of 10. None: the device can copy to no such format.
std::optional<VkSurfaceFormatKHR> chooseFormat(std::span<const VkSurfaceFormatKHR> offered,
                                               const std::function<bool(VkFormat)>& canCopyTo);

// The window paces itself, and presenting holds the mutex of the queue. On a shared queue the passes wait for
// that mutex, so a mode that waits for the display is the last choice there. A software device copies whole
// images, so Immediate does not tear and needs no thread that waits for the display.
VkPresentModeKHR chooseMode(std::span<const VkPresentModeKHR> offered, DeviceKind kind, bool sharesQueue);

// Of the images: the surface's own size, else the wanted one within its limits. 0 x 0 where it is minimised.
VkExtent2D chooseSize(const VkSurfaceCapabilitiesKHR& offered, VkExtent2D wanted);

// Opaque, else any other: the images have no transparency.
VkCompositeAlphaFlagBitsKHR chooseAlpha(VkCompositeAlphaFlagsKHR offered);

} // namespace fathom::operate
