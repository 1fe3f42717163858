// SPDX-License-Identifier: Apache-2.0
// The tab of the haptic device: what is connected, which buttons are pressed, and what they do.
#pragma once

#include "apps/operate/button_map.h"
#include "apps/operate/console.h"
#include "apps/operate/theme.h"

#include <string>

namespace fathom::operate {

// The device of a run.
struct HandDeviceFacts {
    std::string description; // empty: mouse and keyboard, or a recording
    bool present = true;
    uint32_t buttonsDown = 0; // buttons down at the last tick, as the device reports them
    const ButtonMap* buttons = nullptr;
};

// Starts a mapping (Console::Editing::mapping) by a button of the panel.
void drawDevice(Console& console, const HandDeviceFacts& device, const Fonts& fonts);

} // namespace fathom::operate
