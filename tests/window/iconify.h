// SPDX-License-Identifier: Apache-2.0
// What a window manager does with a window that is minimised; the display of the tests has none.
#pragma once

#include <string>

namespace fathom::window {

// display: ":N"; window: its number, in words. False: no such display.
bool iconify(const std::string& display, const std::string& window, bool iconic);

} // namespace fathom::window
