// SPDX-License-Identifier: Apache-2.0
// What a run draws on: surface, painter, letters; and screenshots of it.
#pragma once

#include "apps/operate/console.h"
#include "apps/operate/operate_session.h"
#include "apps/operate/painter.h"
#include "apps/operate/theme.h"
#include "apps/operate/window.h"

#include <memory>

namespace fathom::operate {

// Thread: the window's. Window and session outlive it.
class Canvas {
public:
    // shots: folder of screenshots. Throws Error, DeviceLost.
    Canvas(const Window& window, OperateSession& session, double textScale, std::filesystem::path shots);
    ~Canvas();
    Canvas(const Canvas&) = delete;
    Canvas& operator=(const Canvas&) = delete;

    // The ImGui frame that is open, over the layers; then the screenshot and the size of letters that the
    // console asks for.
    void finishFrame(Console& console, std::span<const Layer> layers, const std::function<bool()>& busy);

    const Letters& letters() const { return letters_; }
    const Painter& painter() const { return *painter_; }
    uint32_t swapchains() const; // made so far

private:
    struct Surface; // surface and swapchain
    void shoot(Console& console);

    const Window& window_;
    std::filesystem::path shots_;
    double scale_;
    std::unique_ptr<Surface> surface_; // null: offscreen
    std::unique_ptr<Painter> painter_;
    Letters letters_;
};

} // namespace fathom::operate
