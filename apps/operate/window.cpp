// SPDX-License-Identifier: Apache-2.0
#define GLFW_INCLUDE_VULKAN
#include "apps/operate/window.h"

#include "apps/operate/monitor_scale.h"
#include "engine/gpu/result.h"
#include "engine/types/clock.h"
#include "engine/types/error.h"
#include "engine/types/log.h"

#include <GLFW/glfw3.h>
#include <algorithm>
#include <backends/imgui_impl_glfw.h>
#include <chrono>
#include <cstdlib>
#include <imgui.h>
#include <optional>
#include <thread>
#include <utility>

namespace fathom::operate {

namespace {

constexpr int kWidth = 1280, kHeight = 720;
constexpr uint32_t kMinSize = 320, kMaxSize = 8192; // [pixels] range of offscreen sizes

VkExtent2D sizeFrom(const std::string& text) {
    VkExtent2D size{};
    char rest = 0;
    if (std::sscanf(text.c_str(), "%ux%u%c", &size.width, &size.height, &rest) != 2 ||
        size.width < kMinSize || size.height < kMinSize || size.width > kMaxSize || size.height > kMaxSize) {
        throw BadInput("operate", "--offscreen", "'" + text + "'", "WxH, each 320 to 8192 pixels");
    }
    return size;
}

// Prefers X, which every desktop offers: Wayland does not report that a window is minimised, and a minimised
// window must have no forces. GLFW before 3.4 has X only.
bool openDisplay() {
#ifdef GLFW_PLATFORM
    glfwInitHint(GLFW_PLATFORM, GLFW_PLATFORM_X11);
    if (glfwInit() == GLFW_TRUE) {
        return true;
    }
    glfwInitHint(GLFW_PLATFORM, GLFW_ANY_PLATFORM);
    const bool open = glfwInit() == GLFW_TRUE;
    if (open) {
        log::warn("no X display (XWayland): a minimised window keeps its forces, because Wayland does not "
                  "report it");
    }
    return open;
#else
    return glfwInit() == GLFW_TRUE;
#endif
}

[[noreturn]] void refuseDisplay() {
    const char* display = std::getenv("DISPLAY");
    const char* why = nullptr;
    glfwGetError(&why);
    std::string value = display != nullptr ? "DISPLAY=" + std::string(display) : "DISPLAY is not set";
    if (why != nullptr) { // some end with a space
        value += ", " + std::string(why);
        value.erase(value.find_last_not_of(' ') + 1);
    }
    throw BadInput("operate", "display", value, "a display that can be opened, or --offscreen WxH");
}

} // namespace

Window::Window(const std::string& offscreen, const std::string& title) {
    if (!offscreen.empty()) {
        offscreen_ = sizeFrom(offscreen);
    } else {
        if (!openDisplay()) {
            refuseDisplay();
        }
        create(title);
    }
    IMGUI_CHECKVERSION();
    ImGui::CreateContext();
    ImGui::GetIO().IniFilename = nullptr; // settings are stored in the scene file
    if (window_ != nullptr) {
        ImGui_ImplGlfw_InitForVulkan(window_, true);
        glfwSetKeyCallback(window_, key); // replaces ImGui's callback: holdTaps() passes the keys
    }
    before_ = monotonicSeconds();
}

// As large as its text needs, if the monitor has that room.
void Window::create(const std::string& title) {
    const double scale = operate::monitorScale(monitorOf(nullptr));
    int x = 0, y = 0, width = 0, height = 0;
    if (GLFWmonitor* first = glfwGetPrimaryMonitor(); first != nullptr) {
        glfwGetMonitorWorkarea(first, &x, &y, &width, &height);
    }
    const auto sized = [&](int usual, int room) {
        const int wanted = static_cast<int>(usual * scale);
        return room > 0 ? std::min(wanted, room) : wanted;
    };
    glfwWindowHint(GLFW_CLIENT_API, GLFW_NO_API);
    window_ = glfwCreateWindow(sized(kWidth, width), sized(kHeight, height), title.c_str(), nullptr, nullptr);
    if (window_ == nullptr || glfwVulkanSupported() != GLFW_TRUE) {
        refuseDisplay();
    }
    glfwSetWindowSizeLimits(window_, 640, 400, GLFW_DONT_CARE, GLFW_DONT_CARE);
    glfwSetWindowUserPointer(window_, this);
    glfwSetWindowPosCallback(window_, [](GLFWwindow* at, int, int) { of(at).moved_ = true; });
    glfwSetWindowRefreshCallback(window_, [](GLFWwindow* at) { of(at).exposed_ = true; });
    glfwSetWindowContentScaleCallback(window_, [](GLFWwindow* at, float, float) { of(at).moved_ = true; });
}

Window& Window::of(GLFWwindow* window) {
    return *static_cast<Window*>(glfwGetWindowUserPointer(window));
}

Window::~Window() {
    if (window_ != nullptr) {
        ImGui_ImplGlfw_Shutdown();
    }
    ImGui::DestroyContext();
    if (window_ != nullptr) {
        glfwDestroyWindow(window_);
        glfwTerminate();
    }
}

void Window::holdTaps() {
    KeysDown down = live_;
    bool control = live_[GLFW_KEY_LEFT_CONTROL] || live_[GLFW_KEY_RIGHT_CONTROL];
    bool shift = live_[GLFW_KEY_LEFT_SHIFT] || live_[GLFW_KEY_RIGHT_SHIFT];
    std::vector<Tap> later;
    std::vector<int> seen;   // keys tapped so far
    std::optional<int> mods; // modifiers of this frame; presses with others wait for the next one
    for (const Tap& tap : taps_) {
        const auto key = static_cast<size_t>(tap.key);
        const bool now = std::find(seen.begin(), seen.end(), tap.key) != seen.end();
        const bool modifier = tap.key >= GLFW_KEY_LEFT_SHIFT && tap.key <= GLFW_KEY_RIGHT_SUPER;
        const bool other = !modifier && (!later.empty() || mods.value_or(tap.mods) != tap.mods);
        seen.push_back(tap.key);
        if (other || now || shown_[key]) { // released for one frame, then pressed again
            down[key] = now && down[key];
            later.push_back(tap);
            continue;
        }
        down[key] = true;
        mods = modifier ? mods : tap.mods;
    }
    if (mods) {
        control = (*mods & GLFW_MOD_CONTROL) != 0;
        shift = (*mods & GLFW_MOD_SHIFT) != 0;
    }
    taps_ = std::move(later);
    shown_ = down;
    passKeys(window_, down, control, shift);
}

void Window::key(GLFWwindow* window, int key, int, int action, int mods) {
    Window* const self = &of(window);
    if (key == GLFW_KEY_SPACE && action == GLFW_PRESS) {
        self->taps_.clear(); // discards earlier presses
        dropQueuedKeys();
    }
    if (key >= 0 && static_cast<size_t>(key) < self->live_.size()) {
        self->live_[static_cast<size_t>(key)] = action != GLFW_RELEASE;
        if (action == GLFW_PRESS) {
            self->taps_.push_back({key, mods});
        }
    }
    if (key == GLFW_KEY_SPACE && action == GLFW_PRESS && self->onForcesOff) {
        self->onForcesOff();
    }
}

std::span<const char* const> Window::extensions() const {
    if (window_ == nullptr) {
        return {};
    }
    uint32_t count = 0;
    const char** names = glfwGetRequiredInstanceExtensions(&count);
    return {names, names != nullptr ? count : 0};
}

VkSurfaceKHR Window::makeSurface(const gpu::Instance& instance) const {
    VkSurfaceKHR surface = VK_NULL_HANDLE;
    gpu::check(glfwCreateWindowSurface(instance.handle(), window_, nullptr, &surface),
               "glfwCreateWindowSurface");
    return surface;
}

void Window::beginFrame(double patience) {
    ImGuiIO& io = ImGui::GetIO();
    if (window_ != nullptr) {
        const double until = monotonicSeconds() + patience;
        glfwPollEvents();
        while (monotonicSeconds() < until) { // handles events at once and keeps the frame rate
            constexpr double kPoll = 0.002;  // [s] polls, because the swapchain uses the same X connection
            std::this_thread::sleep_for(
                std::chrono::duration<double>(std::min(kPoll, until - monotonicSeconds())));
            glfwPollEvents();
        }
        if (std::exchange(moved_, false)) {
            monitorScale_ = operate::monitorScale(monitorOf(window_));
        }
        ImGui_ImplGlfw_NewFrame();
        holdTaps();
    } else {
        std::this_thread::sleep_for(std::chrono::duration<double>(std::max(0.0, patience)));
        io.DisplaySize = {static_cast<float>(offscreen_.width), static_cast<float>(offscreen_.height)};
        io.DeltaTime = static_cast<float>(std::max(1e-4, monotonicSeconds() - before_));
    }
    before_ = monotonicSeconds();
    ImGui::NewFrame();
}

void Window::setTitle(const std::string& title) {
    if (window_ != nullptr) {
        glfwSetWindowTitle(window_, title.c_str());
    }
}

void Window::setFullScreen(bool full) {
    if (window_ == nullptr || full == full_.on) {
        return;
    }
    full_.on = full;
    if (!full) {
        glfwSetWindowMonitor(window_, nullptr, full_.x, full_.y, full_.width, full_.height, GLFW_DONT_CARE);
        return;
    }
    glfwGetWindowPos(window_, &full_.x, &full_.y);
    glfwGetWindowSize(window_, &full_.width, &full_.height);
    GLFWmonitor* monitor = monitorWith(window_);
    const GLFWvidmode* mode = monitor != nullptr ? glfwGetVideoMode(monitor) : nullptr;
    if (mode != nullptr) {
        glfwSetWindowAttrib(window_, GLFW_AUTO_ICONIFY, GLFW_FALSE); // minimising turns forces off
        glfwSetWindowMonitor(window_, monitor, 0, 0, mode->width, mode->height, mode->refreshRate);
    }
}

bool Window::takeClose() {
    const bool pressed = window_ != nullptr && glfwWindowShouldClose(window_) == GLFW_TRUE;
    if (pressed) {
        glfwSetWindowShouldClose(window_, GLFW_FALSE);
    }
    return pressed;
}

bool Window::takeExposed() {
    return std::exchange(exposed_, false);
}

bool Window::minimised() const {
    return window_ != nullptr &&
           (glfwGetWindowAttrib(window_, GLFW_ICONIFIED) == GLFW_TRUE || size().width == 0);
}

VkExtent2D Window::size() const {
    if (window_ == nullptr) {
        return offscreen_;
    }
    int width = 0, height = 0;
    glfwGetFramebufferSize(window_, &width, &height);
    return {static_cast<uint32_t>(width), static_cast<uint32_t>(height)};
}

} // namespace fathom::operate
