// SPDX-License-Identifier: Apache-2.0
// The number of tool leaves from which a device answers contact queries faster than the CPU. `fathom profile
// query` measures it and stores it in the cache folder.
#pragma once

#include <cstdint>
#include <string>
#include <vulkan/vulkan.h>

namespace fathom::gpu {

// File for one device and driver in the user's cache folder; empty when there is no such folder.
std::string cacheFileOf(VkPhysicalDevice device, const std::string& extension);

// The stored number, else `fallback`. Never throws; a damaged file counts as missing.
uint32_t storedQueryCrossover(VkPhysicalDevice device, uint32_t fallback) noexcept;
// Returns false when the number could not be stored.
bool storeQueryCrossover(VkPhysicalDevice device, uint32_t leaves) noexcept;

} // namespace fathom::gpu
