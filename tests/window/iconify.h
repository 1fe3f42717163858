// SPDX-License-Identifier: Apache-2.0
// Minimises and closes a window like a window manager, which the display of the tests lacks.
#pragma once

#include <string>

namespace fathom::window {

// Like the close button of a window manager.
bool askToClose(const std::string& display, const std::string& window);
// display: ":N"; window: its id as text. False when there is no such display.
bool iconify(const std::string& display, const std::string& window, bool iconic);

} // namespace fathom::window
