// SPDX-License-Identifier: Apache-2.0
// Vulkan result codes as exceptions.
#pragma once

#include <vulkan/vulkan.h>

namespace fathom::gpu {

// Throws DeviceLost for a lost device, OutOfMemory, and Error for all else below VK_SUCCESS; each names the
// call and the code.
void check(VkResult result, const char* call);

} // namespace fathom::gpu
