// SPDX-License-Identifier: Apache-2.0
#include "apps/operate/keys.h"

#include <GLFW/glfw3.h>
#include <algorithm>
#include <imgui.h>

namespace fathom::operate {

#if IMGUI_VERSION_NUM < 18700

bool keyDown(int key) {
    return ImGui::IsKeyDown(key);
}

bool keyPressed(int key, bool repeat) {
    return ImGui::IsKeyPressed(key, repeat);
}

void passKeys(GLFWwindow*, const KeysDown& down, bool control, bool shift) {
    ImGuiIO& io = ImGui::GetIO();
    io.KeyMap[ImGuiKey_Space] = GLFW_KEY_ENTER;
    std::copy(down.begin(), down.end(), std::begin(io.KeysDown));
    io.KeyCtrl = control;
    io.KeyShift = shift;
    io.KeyAlt = down[GLFW_KEY_LEFT_ALT] || down[GLFW_KEY_RIGHT_ALT];
    io.KeySuper = down[GLFW_KEY_LEFT_SUPER] || down[GLFW_KEY_RIGHT_SUPER];
}

void dropQueuedKeys() {}

#else

namespace {

struct Range {
    int first, last; // GLFW codes
    ImGuiKey to;     // ImGui's key for `first`
};

constexpr Range kRanges[] = {
    {GLFW_KEY_0, GLFW_KEY_9, ImGuiKey_0},
    {GLFW_KEY_A, GLFW_KEY_Z, ImGuiKey_A},
    {GLFW_KEY_F1, GLFW_KEY_F12, ImGuiKey_F1},
    {GLFW_KEY_KP_0, GLFW_KEY_KP_9, ImGuiKey_Keypad0},
    {GLFW_KEY_LEFT_SHIFT, GLFW_KEY_LEFT_SHIFT, ImGuiKey_LeftShift},
    {GLFW_KEY_LEFT_CONTROL, GLFW_KEY_LEFT_CONTROL, ImGuiKey_LeftCtrl},
    {GLFW_KEY_LEFT_ALT, GLFW_KEY_LEFT_ALT, ImGuiKey_LeftAlt},
    {GLFW_KEY_LEFT_SUPER, GLFW_KEY_LEFT_SUPER, ImGuiKey_LeftSuper},
    {GLFW_KEY_RIGHT_SHIFT, GLFW_KEY_RIGHT_SHIFT, ImGuiKey_RightShift},
    {GLFW_KEY_RIGHT_CONTROL, GLFW_KEY_RIGHT_CONTROL, ImGuiKey_RightCtrl},
    {GLFW_KEY_RIGHT_ALT, GLFW_KEY_RIGHT_ALT, ImGuiKey_RightAlt},
    {GLFW_KEY_RIGHT_SUPER, GLFW_KEY_RIGHT_SUPER, ImGuiKey_RightSuper},
    {GLFW_KEY_SPACE, GLFW_KEY_SPACE, ImGuiKey_F24}, // ImGui's own Space would press the selected item
    {GLFW_KEY_ESCAPE, GLFW_KEY_ESCAPE, ImGuiKey_Escape},
    {GLFW_KEY_ENTER, GLFW_KEY_ENTER, ImGuiKey_Enter},
    {GLFW_KEY_TAB, GLFW_KEY_TAB, ImGuiKey_Tab},
    {GLFW_KEY_BACKSPACE, GLFW_KEY_BACKSPACE, ImGuiKey_Backspace},
    {GLFW_KEY_INSERT, GLFW_KEY_INSERT, ImGuiKey_Insert},
    {GLFW_KEY_DELETE, GLFW_KEY_DELETE, ImGuiKey_Delete},
    {GLFW_KEY_RIGHT, GLFW_KEY_RIGHT, ImGuiKey_RightArrow},
    {GLFW_KEY_LEFT, GLFW_KEY_LEFT, ImGuiKey_LeftArrow},
    {GLFW_KEY_DOWN, GLFW_KEY_DOWN, ImGuiKey_DownArrow},
    {GLFW_KEY_UP, GLFW_KEY_UP, ImGuiKey_UpArrow},
    {GLFW_KEY_PAGE_UP, GLFW_KEY_PAGE_UP, ImGuiKey_PageUp},
    {GLFW_KEY_PAGE_DOWN, GLFW_KEY_PAGE_DOWN, ImGuiKey_PageDown},
    {GLFW_KEY_HOME, GLFW_KEY_HOME, ImGuiKey_Home},
    {GLFW_KEY_END, GLFW_KEY_END, ImGuiKey_End},
    {GLFW_KEY_APOSTROPHE, GLFW_KEY_APOSTROPHE, ImGuiKey_Apostrophe},
    {GLFW_KEY_COMMA, GLFW_KEY_COMMA, ImGuiKey_Comma},
    {GLFW_KEY_MINUS, GLFW_KEY_MINUS, ImGuiKey_Minus},
    {GLFW_KEY_PERIOD, GLFW_KEY_PERIOD, ImGuiKey_Period},
    {GLFW_KEY_SLASH, GLFW_KEY_SLASH, ImGuiKey_Slash},
    {GLFW_KEY_SEMICOLON, GLFW_KEY_SEMICOLON, ImGuiKey_Semicolon},
    {GLFW_KEY_EQUAL, GLFW_KEY_EQUAL, ImGuiKey_Equal},
    {GLFW_KEY_LEFT_BRACKET, GLFW_KEY_LEFT_BRACKET, ImGuiKey_LeftBracket},
    {GLFW_KEY_BACKSLASH, GLFW_KEY_BACKSLASH, ImGuiKey_Backslash},
    {GLFW_KEY_RIGHT_BRACKET, GLFW_KEY_RIGHT_BRACKET, ImGuiKey_RightBracket},
    {GLFW_KEY_GRAVE_ACCENT, GLFW_KEY_GRAVE_ACCENT, ImGuiKey_GraveAccent},
    {GLFW_KEY_KP_DECIMAL, GLFW_KEY_KP_DECIMAL, ImGuiKey_KeypadDecimal},
    {GLFW_KEY_KP_DIVIDE, GLFW_KEY_KP_DIVIDE, ImGuiKey_KeypadDivide},
    {GLFW_KEY_KP_MULTIPLY, GLFW_KEY_KP_MULTIPLY, ImGuiKey_KeypadMultiply},
    {GLFW_KEY_KP_SUBTRACT, GLFW_KEY_KP_SUBTRACT, ImGuiKey_KeypadSubtract},
    {GLFW_KEY_KP_ADD, GLFW_KEY_KP_ADD, ImGuiKey_KeypadAdd},
    {GLFW_KEY_KP_ENTER, GLFW_KEY_KP_ENTER, ImGuiKey_KeypadEnter},
    {GLFW_KEY_KP_EQUAL, GLFW_KEY_KP_EQUAL, ImGuiKey_KeypadEqual},
};

ImGuiKey imguiKey(int key) {
    for (const Range& range : kRanges) {
        if (key >= range.first && key <= range.last) {
            return static_cast<ImGuiKey>(range.to + (key - range.first));
        }
    }
    return ImGuiKey_None;
}

} // namespace

bool keyDown(int key) {
    return ImGui::IsKeyDown(imguiKey(key));
}

bool keyPressed(int key, bool repeat) {
    return ImGui::IsKeyPressed(imguiKey(key), repeat);
}

// ImGui ignores unchanged keys. Mouse buttons are sent again for dropQueuedKeys().
void passKeys(GLFWwindow* window, const KeysDown& down, bool control, bool shift) {
    ImGuiIO& io = ImGui::GetIO();
    io.AddKeyEvent(ImGuiMod_Ctrl, control);
    io.AddKeyEvent(ImGuiMod_Shift, shift);
    io.AddKeyEvent(ImGuiMod_Alt, down[GLFW_KEY_LEFT_ALT] || down[GLFW_KEY_RIGHT_ALT]);
    io.AddKeyEvent(ImGuiMod_Super, down[GLFW_KEY_LEFT_SUPER] || down[GLFW_KEY_RIGHT_SUPER]);
    for (const Range& range : kRanges) {
        for (int key = range.first; key <= range.last; ++key) {
            io.AddKeyEvent(imguiKey(key), down[static_cast<size_t>(key)]);
        }
    }
    for (int button = GLFW_MOUSE_BUTTON_1; button <= GLFW_MOUSE_BUTTON_3; ++button) {
        io.AddMouseButtonEvent(button, glfwGetMouseButton(window, button) == GLFW_PRESS);
    }
}

void dropQueuedKeys() {
    ImGui::GetIO().ClearEventsQueue();
}

#endif

} // namespace fathom::operate
