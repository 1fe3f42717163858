// SPDX-License-Identifier: Apache-2.0
// From how many tool leaves on this device answers contact queries faster than the CPU: measured by `fathom
// profile query`, kept beside the pipelines of the device.
#pragma once

#include <cstdint>
#include <string>
#include <vulkan/vulkan.h>

namespace fathom::gpu {

// Leaves that no tool has: the CPU answers always.
inline constexpr uint32_t kNeverOnGpu = 0xffffffffu;

// File of one device and driver in the user's cache folder; empty when there is no such folder.
std::string cacheFileOf(VkPhysicalDevice device, const std::string& extension);

// What was stored last, else `fallback`. Never throws: a damaged file is as good as none.
uint32_t storedQueryCrossover(VkPhysicalDevice device, uint32_t fallback) noexcept;
// False when it could not be stored.
bool storeQueryCrossover(VkPhysicalDevice device, uint32_t leaves) noexcept;

} // namespace fathom::gpu
