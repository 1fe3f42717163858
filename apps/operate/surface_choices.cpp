// SPDX-License-Identifier: Apache-2.0
#include "apps/operate/surface_choices.h"

#include <algorithm>

namespace fathom::operate {

VkPresentModeKHR chooseMode(std::span<const VkPresentModeKHR> offered, DeviceKind kind, bool sharesQueue) {
    const auto has = [&](VkPresentModeKHR mode) { return std::ranges::find(offered, mode) != offered.end(); };
    if (kind != DeviceKind::Cpu && sharesQueue && has(VK_PRESENT_MODE_MAILBOX_KHR)) {
        return VK_PRESENT_MODE_MAILBOX_KHR;
    }
    return (kind == DeviceKind::Cpu || sharesQueue) && has(VK_PRESENT_MODE_IMMEDIATE_KHR)
               ? VK_PRESENT_MODE_IMMEDIATE_KHR
               : VK_PRESENT_MODE_FIFO_KHR;
}

} // namespace fathom::operate
