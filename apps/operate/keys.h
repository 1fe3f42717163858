// SPDX-License-Identifier: Apache-2.0
// Keys by their GLFW codes for every version of ImGui, which has its own key codes since 1.87.
#pragma once

#include <array>

struct GLFWwindow;

namespace fathom::operate {

using KeysDown = std::array<bool, 512>; // by GLFW code

// In the current ImGui frame.
bool keyDown(int key);
bool keyPressed(int key, bool repeat = false);

// Passes this frame's keys to ImGui. Enter presses the selected item there, because Space turns forces off.
void passKeys(GLFWwindow* window, const KeysDown& down, bool control, bool shift);

// Drops the key presses that ImGui has queued for a later frame.
void dropQueuedKeys();

} // namespace fathom::operate
