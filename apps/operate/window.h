// SPDX-License-Identifier: Apache-2.0
// The window, or an offscreen replacement of fixed size: handles events, provides size and surface.
#pragma once

#include "apps/operate/keys.h"
#include "engine/gpu/instance.h"

#include <functional>
#include <span>
#include <string>
#include <vector>

struct GLFWwindow;

namespace fathom::operate {

// Main thread, as GLFW requires. Owns the ImGui context.
class Window {
public:
    // offscreen: "WxH", or empty for a window of 1280x720, larger on a dense monitor. Throws BadInput without
    // a display or for a bad size.
    Window(const std::string& offscreen, const std::string& title);
    ~Window();
    Window(const Window&) = delete;
    Window& operator=(const Window&) = delete;

    std::span<const char* const> extensions() const; // instance extensions
    VkSurfaceKHR makeSurface(const gpu::Instance& instance) const;
    bool offscreen() const { return window_ == nullptr; }

    // Called as soon as the key for forces off is pressed, whatever widget has the focus.
    std::function<void()> onForcesOff;

    // Handles events for `patience` [s] and begins an ImGui frame.
    void beginFrame(double patience);
    void setTitle(const std::string& title);
    void setFullScreen(bool full); // on the monitor that it is on; false: as it was before
    bool takeClose();              // the close button was pressed since the last call
    bool takeExposed();            // a part was uncovered since the last call: show the frame again
    bool minimised() const;
    double monitorScale() const { return monitorScale_; } // of the monitor that it is on; offscreen 1
    VkExtent2D size() const;                              // [pixels]

private:
    // A key pressed and released between two frames counts as pressed in the next frame; a second press
    // counts in the frame after the next.
    void holdTaps();

    static void key(GLFWwindow* window, int key, int scan, int action, int mods);
    static Window& of(GLFWwindow* window);
    void create(const std::string& title);
    GLFWwindow* window_ = nullptr;
    VkExtent2D offscreen_{};
    struct Tap {
        int key = 0, mods = 0;
    };
    std::vector<Tap> taps_; // key presses since the last frame
    KeysDown live_{};       // down now, as GLFW reports them
    KeysDown shown_{};      // down in the last frame
    double before_ = 0.0;
    double monitorScale_ = 1.0;
    bool moved_ = true; // perhaps to another monitor
    bool exposed_ = false;
    struct {
        bool on = false;
        int x = 0, y = 0, width = 0, height = 0; // before
    } full_;
};

} // namespace fathom::operate
