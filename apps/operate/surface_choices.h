// SPDX-License-Identifier: Apache-2.0
// What a swapchain uses of that which a surface offers.
#pragma once

#include "engine/types/device_facts.h"

#include <functional>
#include <span>
#include <vulkan/vulkan.h>

namespace fathom::operate {

// The window paces itself, and presenting holds the mutex of the queue. On a shared queue the passes wait for
// that mutex, so a mode that waits for the display is the last choice there. A software device copies whole
// images, so Immediate does not tear and needs no thread that waits for the display.
VkPresentModeKHR chooseMode(std::span<const VkPresentModeKHR> offered, DeviceKind kind, bool sharesQueue);

} // namespace fathom::operate
