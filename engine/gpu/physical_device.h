// SPDX-License-Identifier: Apache-2.0
// Facts of a physical device and the choice between several.
#pragma once

#include "engine/gpu/instance.h"
#include "engine/types/device_facts.h"

#include <optional>
#include <string>

namespace fathom::gpu {

// What the driver says of a device; hostProcessors is of the thread that asks.
DeviceFacts readFacts(VkPhysicalDevice device);

// Queue family to use: compute, preferably without graphics. Empty when none computes.
std::optional<uint32_t> computeFamily(VkPhysicalDevice device);

// Empty when the device is usable; otherwise why it is not.
std::string refusal(VkPhysicalDevice device);

// See Device's constructor. Throws BadInput.
VkPhysicalDevice choosePhysicalDevice(const Instance& instance, const std::string& selector);

// Whether the device offers the extension of that name.
bool hasExtension(VkPhysicalDevice device, const char* name);

} // namespace fathom::gpu
