// SPDX-License-Identifier: Apache-2.0
// Vulkan result codes as exceptions.
#pragma once

#include <vulkan/vulkan.h>

namespace fathom::gpu {

// Throws DeviceLost, OutOfMemory, or Error for any other code below VK_SUCCESS. The message names the call
// and the code.
void check(VkResult result, const char* call);

} // namespace fathom::gpu
