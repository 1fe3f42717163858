// SPDX-License-Identifier: Apache-2.0
#include "apps/operate/surface_choices.h"

#include <algorithm>
#include <array>

namespace fathom::operate {

std::optional<VkSurfaceFormatKHR> chooseFormat(std::span<const VkSurfaceFormatKHR> offered,
                                               const std::function<bool(VkFormat)>& canCopyTo) {
    constexpr std::array kFormats = {
        std::array{VK_FORMAT_B8G8R8A8_UNORM, VK_FORMAT_R8G8B8A8_UNORM},
        std::array{VK_FORMAT_A2R10G10B10_UNORM_PACK32, VK_FORMAT_A2B10G10R10_UNORM_PACK32}};
    for (const auto& accepted : kFormats) {
        for (const VkSurfaceFormatKHR& f : offered) {
            if (std::ranges::find(accepted, f.format) != accepted.end() &&
                f.colorSpace == VK_COLOR_SPACE_SRGB_NONLINEAR_KHR && canCopyTo(f.format)) {
                return f;
            }
        }
    }
    return std::nullopt;
}

VkPresentModeKHR chooseMode(std::span<const VkPresentModeKHR> offered, DeviceKind kind, bool sharesQueue) {
    const auto has = [&](VkPresentModeKHR mode) { return std::ranges::find(offered, mode) != offered.end(); };
    if (kind != DeviceKind::Cpu && sharesQueue && has(VK_PRESENT_MODE_MAILBOX_KHR)) {
        return VK_PRESENT_MODE_MAILBOX_KHR;
    }
    return (kind == DeviceKind::Cpu || sharesQueue) && has(VK_PRESENT_MODE_IMMEDIATE_KHR)
               ? VK_PRESENT_MODE_IMMEDIATE_KHR
               : VK_PRESENT_MODE_FIFO_KHR;
}

VkExtent2D chooseSize(const VkSurfaceCapabilitiesKHR& offered, VkExtent2D wanted) {
    if (offered.currentExtent.width != UINT32_MAX) {
        return offered.currentExtent;
    }
    const VkExtent2D least = offered.minImageExtent, most = offered.maxImageExtent;
    return {std::clamp(wanted.width, least.width, most.width),
            std::clamp(wanted.height, least.height, most.height)};
}

VkCompositeAlphaFlagBitsKHR chooseAlpha(VkCompositeAlphaFlagsKHR offered) {
    const VkCompositeAlphaFlagsKHR lowest = offered & (~offered + 1);
    return (offered & VK_COMPOSITE_ALPHA_OPAQUE_BIT_KHR) != 0
               ? VK_COMPOSITE_ALPHA_OPAQUE_BIT_KHR
               : static_cast<VkCompositeAlphaFlagBitsKHR>(lowest);
}

} // namespace fathom::operate
