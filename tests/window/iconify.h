// SPDX-License-Identifier: Apache-2.0
// What a desktop does, which the display of the tests lacks: minimises and closes a window, sets the
// resolution.
#pragma once

#include <string>

namespace fathom::window {

// Like the close button of a window manager.
bool askToClose(const std::string& display, const std::string& window);
// display: ":N"; window: its id as text. False when there is no such display.
bool iconify(const std::string& display, const std::string& window, bool iconic);

// Sets the resource Xft.dpi [pixels per inch] for programs that start from now on.
bool setResolution(const std::string& display, int perInch);

} // namespace fathom::window
