// SPDX-License-Identifier: Apache-2.0
#include "apps/operate/surface_choices.h"

#include <doctest/doctest.h>
#include <utility>
#include <vector>

using namespace fathom;
using namespace fathom::operate;

TEST_CASE("A device with one queue presents without waiting for the display, if the surface can") {
    constexpr auto kFifo = VK_PRESENT_MODE_FIFO_KHR, kMailbox = VK_PRESENT_MODE_MAILBOX_KHR,
                   kImmediate = VK_PRESENT_MODE_IMMEDIATE_KHR;
    using Modes = std::vector<VkPresentModeKHR>;
    for (const auto kind : {DeviceKind::Integrated, DeviceKind::Discrete}) {
        CHECK(chooseMode(Modes{kFifo, kImmediate, kMailbox}, kind, true) == kMailbox);
        CHECK(chooseMode(Modes{kFifo, kImmediate}, kind, true) == kImmediate);
        CHECK(chooseMode(Modes{kFifo}, kind, true) == kFifo);
        CHECK(chooseMode(Modes{kImmediate, kMailbox, kFifo}, kind, false) == kFifo); // does not tear
    }
    for (const bool sharesQueue : {true, false}) {
        CHECK(chooseMode(Modes{kFifo, kMailbox, kImmediate}, DeviceKind::Cpu, sharesQueue) == kImmediate);
        CHECK(chooseMode(Modes{kFifo, kMailbox}, DeviceKind::Cpu, sharesQueue) == kFifo);
    }
}

TEST_CASE(
    "A display with 10 bits per channel is used if it offers none with 8, and never one that converts") {
    using Formats = std::vector<VkSurfaceFormatKHR>;
    constexpr auto kSrgb = VK_COLOR_SPACE_SRGB_NONLINEAR_KHR;
    constexpr VkSurfaceFormatKHR kEight{VK_FORMAT_B8G8R8A8_UNORM, kSrgb},
        kTen{VK_FORMAT_A2R10G10B10_UNORM_PACK32, kSrgb}, kConverts{VK_FORMAT_B8G8R8A8_SRGB, kSrgb},
        kWide{VK_FORMAT_A2B10G10R10_UNORM_PACK32, VK_COLOR_SPACE_HDR10_ST2084_EXT};
    const auto chosen = [](const Formats& offered, VkFormat without = VK_FORMAT_UNDEFINED) {
        const auto format = chooseFormat(offered, [&](VkFormat f) { return f != without; });
        return format ? format->format : VK_FORMAT_UNDEFINED;
    };
    CHECK(chosen({kTen, kConverts, kEight}) == kEight.format);
    CHECK(chosen({kConverts, kTen}) == kTen.format);
    CHECK(chosen({kTen, kEight}, kEight.format) == kTen.format); // the device cannot copy to the other
    CHECK(chosen({kConverts, kWide}) == VK_FORMAT_UNDEFINED);
}

TEST_CASE("A surface without a size of its own gets the window's, within the surface's limits") {
    VkSurfaceCapabilitiesKHR can{};
    can.minImageExtent = {64, 32};
    can.maxImageExtent = {1000, 2000};
    const auto chosen = [&](uint32_t width, uint32_t height) {
        const VkExtent2D size = chooseSize(can, {width, height});
        return std::pair(size.width, size.height);
    };
    can.currentExtent = {640, 480};
    CHECK(chosen(800, 600) == std::pair(640u, 480u));
    can.currentExtent = {UINT32_MAX, UINT32_MAX};
    CHECK(chosen(800, 600) == std::pair(800u, 600u));
    CHECK(chosen(1200, 600) == std::pair(1000u, 600u));
    CHECK(chosen(50, 20) == std::pair(64u, 32u));
}

TEST_CASE("Images are opaque where the surface can be, else composed in a way that it supports") {
    constexpr VkCompositeAlphaFlagsKHR kOpaque = VK_COMPOSITE_ALPHA_OPAQUE_BIT_KHR,
                                       kAfter = VK_COMPOSITE_ALPHA_POST_MULTIPLIED_BIT_KHR,
                                       kInherit = VK_COMPOSITE_ALPHA_INHERIT_BIT_KHR;
    CHECK(chooseAlpha(kOpaque | kInherit) == kOpaque);
    CHECK(chooseAlpha(kAfter | kInherit) == kAfter);
    CHECK(chooseAlpha(kInherit) == kInherit);
}
