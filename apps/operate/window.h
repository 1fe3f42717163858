// SPDX-License-Identifier: Apache-2.0
// The window itself, or, offscreen, a stand-in of fixed size: events in, a size and a surface out.
#pragma once

#include "apps/operate/keys.h"
#include "engine/gpu/instance.h"

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

struct GLFWwindow;

namespace fathom::operate {

// Thread: main, for its toolkit asks for that. Makes and ends ImGui's context.
class Window {
public:
    // size: "WxH" for offscreen, empty for a window of 1280x720. Throws BadInput when there is no display or
    // the size is none.
    Window(const std::string& offscreen, const std::string& title);
    ~Window();
    Window(const Window&) = delete;
    Window& operator=(const Window&) = delete;

    std::span<const char* const> extensions() const; // of the instance
    VkSurfaceKHR makeSurface(const gpu::Instance& instance) const;
    bool offscreen() const { return window_ == nullptr; }

    // Called at once when the key that turns forces off goes down, whatever widget has the focus.
    std::function<void()> onForcesOff;

    // Takes the events that have come, waits for some up to `patience` [s] and begins an ImGui frame.
    void beginFrame(double patience);
    void setTitle(const std::string& title);
    bool closed() const;
    bool minimised() const;
    VkExtent2D size() const; // [pixels]

private:
    // A key that went down and up between two frames still counts as pressed in the next one, and one that
    // did so twice in the next but one, too.
    void holdTaps();

    static void key(GLFWwindow* window, int key, int scan, int action, int mods);
    GLFWwindow* window_ = nullptr;
    VkExtent2D offscreen_{};
    struct Tap {
        int key = 0, mods = 0;
    };
    std::vector<Tap> taps_; // since the last frame
    KeysDown live_{};       // as GLFW reports them
    KeysDown shown_{};      // down in the last frame
    double before_ = 0.0;
};

} // namespace fathom::operate
