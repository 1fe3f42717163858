// SPDX-License-Identifier: Apache-2.0
#include "engine/gpu/result.h"

#include "engine/types/error.h"

#include <string>

namespace fathom::gpu {

void check(VkResult result, const char* call) {
    if (result >= VK_SUCCESS) {
        return;
    }
    const std::string text = std::string(call) + " failed with VkResult " + std::to_string(result);
    // A driver that restarts after a reset also gives the other two; the device may be opened again.
    if (result == VK_ERROR_DEVICE_LOST || result == VK_ERROR_UNKNOWN ||
        result == VK_ERROR_INITIALIZATION_FAILED) {
        throw DeviceLost(text);
    }
    if (result == VK_ERROR_OUT_OF_DEVICE_MEMORY || result == VK_ERROR_OUT_OF_HOST_MEMORY) {
        throw OutOfMemory(text + ": out of memory");
    }
    throw Error(text);
}

} // namespace fathom::gpu
