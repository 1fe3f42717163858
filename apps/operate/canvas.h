// SPDX-License-Identifier: Apache-2.0
// What a run draws on: surface, painter, letters; and screenshots of it.
#pragma once

#include "apps/operate/console.h"
#include "apps/operate/painter.h"
#include "apps/operate/theme.h"
#include "apps/operate/window.h"

#include <memory>

namespace fathom::operate {

// Thread: the window's. Window and instance outlive it, a device what is open on it.
class Canvas {
public:
    // shots: folder of screenshots. Nothing is on a device yet.
    Canvas(const Window& window, const gpu::Instance& instance, double textScale,
           std::filesystem::path shots);
    ~Canvas();
    Canvas(const Canvas&) = delete;
    Canvas& operator=(const Canvas&) = delete;

    // Everything that is on a device, made on this one; between two ImGui frames. Throws Error, DeviceLost:
    // then nothing is on it.
    void open(gpu::Device& device);
    void drop(); // all of it destroyed; counts, letters and what is asked for stay
    bool isOpen() const { return onDevice_ != nullptr; }

    // The ImGui frame that is open, over the layers; then the screenshot and the size of letters that the
    // console asks for. Without a device the frame ends unseen. Throws DeviceFailed: to be dropped.
    void finishFrame(Console& console, std::span<const Layer> layers, const std::function<bool()>& busy);

    const Letters& letters() const { return letters_; }
    struct Counts {                      // so far, on all devices
        uint64_t drawn = 0, yielded = 0; // frames
        uint32_t swapchains = 0;
    };
    Counts counts() const;

private:
    struct OnDevice; // surface, swapchain, painter
    void shoot(Console& console);

    const Window& window_;
    const gpu::Instance& instance_;
    std::filesystem::path shots_;
    double scale_;
    std::unique_ptr<OnDevice> onDevice_; // null: no device
    Counts before_;                      // on devices that are gone
    Letters letters_;
};

} // namespace fathom::operate
