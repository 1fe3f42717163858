// SPDX-License-Identifier: Apache-2.0
// Vulkan result codes as exceptions.
#pragma once

#include <vulkan/vulkan.h>

namespace fathom::gpu {

// Throws DeviceLost for a lost device and Error, naming the call and the code, for everything below
// VK_SUCCESS.
void check(VkResult result, const char* call);

} // namespace fathom::gpu
