// SPDX-License-Identifier: Apache-2.0
#include "apps/operate/canvas.h"

#include "engine/types/error.h"

#include <imgui.h>
#include <utility>

namespace fathom::operate {

struct Canvas::Surface {
    Surface(const Window& window, OperateSession& session)
        : instance(session.instance)
        , handle(window.makeSurface(session.instance)) {
        try {
            swapchain = std::make_unique<Swapchain>(session.device, handle);
        } catch (...) {
            vkDestroySurfaceKHR(instance.handle(), handle, nullptr);
            throw;
        }
    }
    ~Surface() {
        swapchain.reset();
        vkDestroySurfaceKHR(instance.handle(), handle, nullptr);
    }
    const gpu::Instance& instance;
    VkSurfaceKHR handle;
    std::unique_ptr<Swapchain> swapchain;
};

Canvas::Canvas(const Window& window, OperateSession& session, double textScale, std::filesystem::path shots)
    : window_(window)
    , shots_(std::move(shots))
    , scale_(textScale)
    , surface_(window.offscreen() ? nullptr : std::make_unique<Surface>(window, session))
    , letters_(loadLetters(textScale)) {
    applyTheme(scale_);
    painter_ = std::make_unique<Painter>(session.instance, session.device,
                                         surface_ ? surface_->swapchain.get() : nullptr);
}

Canvas::~Canvas() {
    painter_.reset();
}

void Canvas::finishFrame(Console& console, std::span<const Layer> layers, const std::function<bool()>& busy) {
    ImGui::Render();
    if (std::exchange(console.remake, false) && surface_) {
        surface_->swapchain->lose();
    }
    if (!window_.minimised()) {
        painter_->draw(window_.size(), layers, ImGui::GetDrawData(), busy);
    }
    if (console.screenshot) {
        console.screenshot = false;
        shoot(console);
    }
    if (scale_ != console.textScale) {
        scale_ = console.textScale;
        letters_ = loadLetters(scale_);
        applyTheme(scale_);
        painter_->uploadFonts();
    }
}

void Canvas::shoot(Console& console) {
    const auto file = shots_ / ("screenshot-" + std::to_string(console.shots + 1) + ".png");
    try {
        painter_->screenshot(file);
        ++console.shots;
        console.tell("screenshot " + file.string());
    } catch (const Error& e) {
        console.tell(e.what());
    }
}

uint32_t Canvas::swapchains() const {
    return surface_ ? surface_->swapchain->remade() : 0;
}

} // namespace fathom::operate
