// SPDX-License-Identifier: Apache-2.0
// Draws the window's frames: surface, painter, fonts and screenshots.
#pragma once

#include "apps/operate/console.h"
#include "apps/operate/painter.h"
#include "apps/operate/theme.h"
#include "apps/operate/window.h"

#include <memory>

namespace fathom::operate {

inline constexpr const char* kOffscreenShot = "screenshot-1.png"; // every time, as programs expect

// Window thread. Window and instance outlive it; a device outlives the objects open on it.
class Canvas {
public:
    // shots: folder of screenshots. Uses no device before open().
    Canvas(Window& window, const gpu::Instance& instance, double textScale, std::filesystem::path shots);
    ~Canvas();
    Canvas(const Canvas&) = delete;
    Canvas& operator=(const Canvas&) = delete;

    // Creates all device objects; call between two ImGui frames. Throws Error, DeviceLost: then none exist.
    void open(gpu::Device& device);
    void drop(); // destroys all device objects; keeps counts, fonts and pending requests
    bool isOpen() const { return onDevice_ != nullptr; }

    // Draws the open ImGui frame over the layers, then handles requests for screenshots and font size. If the
    // frame is not drawn, a screenshot waits for the next one. Without a device the frame is discarded.
    // Throws DeviceFailed: call drop().
    void finishFrame(Console& console, std::span<const Layer> layers, const std::function<bool()>& busy);

    // The frame of the last finishFrame(), with the lines of console.status.caption under it. Null: it was
    // not drawn, or there is no device. Throws DeviceFailed: call drop().
    std::unique_ptr<Image> frameImage(const Console& console);

    // Why the last screenshot was not written; empty = it was.
    const std::string& shotFault() const { return shotFault_; }
    const Fonts& fonts() const { return fonts_; }
    struct Counts {                      // Totals over all devices.
        uint64_t drawn = 0, yielded = 0; // window frames drawn, and skipped for passes
        uint32_t swapchains = 0;
        uint64_t tiles = 0; // drawn by the CPU (PanelRaster)
    };
    Counts counts() const;

private:
    bool waits_ = false; // a screenshot, for a frame that is drawn
    struct OnDevice;     // surface, swapchain, painter
    void draw(const Console& console, bool newSwapchain, std::span<const Layer> layers,
              const std::function<bool()>& busy); // needs a device
    bool shoot(Console& console);                 // false: this frame was not drawn

    Window& window_;
    const gpu::Instance& instance_;
    std::filesystem::path shots_;
    double scale_;
    std::unique_ptr<OnDevice> onDevice_; // null: no device
    Counts before_;                      // counts from devices that were dropped
    Fonts fonts_;
    std::string shotFault_ = "the window was not drawn";
};

} // namespace fathom::operate
