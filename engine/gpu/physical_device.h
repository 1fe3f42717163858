// SPDX-License-Identifier: Apache-2.0
// Reads the facts of physical devices and chooses one.
#pragma once

#include "engine/gpu/instance.h"
#include "engine/types/device_facts.h"

#include <optional>
#include <string>
#include <vector>

namespace fathom::gpu {

// Facts that the driver reports, and the number of CPUs that the calling thread may use.
DeviceFacts readFacts(VkPhysicalDevice device);

// The queue families, in the driver's order.
std::vector<VkQueueFamilyProperties> queueFamilies(VkPhysicalDevice device);

// The queue family to use: compute, preferably without graphics. Empty when there is none.
std::optional<uint32_t> computeFamily(VkPhysicalDevice device);

// Empty when the device is usable; otherwise the reason why not.
std::string refusal(VkPhysicalDevice device);

// See Device's constructor. Throws BadInput, DeviceMissing.
VkPhysicalDevice choosePhysicalDevice(const Instance& instance, const std::string& selector);

// Whether the device offers the extension of that name.
bool hasExtension(VkPhysicalDevice device, const char* name);

} // namespace fathom::gpu
