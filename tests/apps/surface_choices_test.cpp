// SPDX-License-Identifier: Apache-2.0
#include "apps/operate/surface_choices.h"

#include <doctest/doctest.h>
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
