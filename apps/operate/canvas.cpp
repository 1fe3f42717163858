// SPDX-License-Identifier: Apache-2.0
#include "apps/operate/canvas.h"

#include "apps/operate/caption.h"
#include "apps/operate/unused_name.h"
#include "engine/types/error.h"

#include <imgui.h>
#include <optional>
#include <utility>

namespace fathom::operate {

struct Canvas::OnDevice {
    // The surface of a window; null when offscreen.
    class Surface {
    public:
        Surface(const Window& window, const gpu::Instance& instance)
            : instance_(instance)
            , handle_(window.offscreen() ? VK_NULL_HANDLE : window.makeSurface(instance)) {}
        ~Surface() {
            if (handle_ != VK_NULL_HANDLE) { // offscreen, the instance may lack the extension
                vkDestroySurfaceKHR(instance_.handle(), handle_, nullptr);
            }
        }
        Surface(const Surface&) = delete;
        Surface& operator=(const Surface&) = delete;
        VkSurfaceKHR handle() const { return handle_; }

    private:
        const gpu::Instance& instance_;
        VkSurfaceKHR handle_;
    };

    OnDevice(const Window& window, const gpu::Instance& instance, gpu::Device& device) {
        surface = std::make_unique<Surface>(window, instance);
        if (surface->handle() != VK_NULL_HANDLE) {
            swapchain.emplace(device, surface->handle());
        }
        painter.emplace(instance, device, swapchain ? &*swapchain : nullptr, Painter::drawerFor(device));
    }
    // A window allows one surface with swapchain images at a time.
    void renewSurface(const Window& window, const gpu::Instance& instance) {
        swapchain->leave();
        surface.reset();
        surface = std::make_unique<Surface>(window, instance);
        swapchain->moveTo(surface->handle());
    }
    std::unique_ptr<Surface> surface;
    std::optional<Swapchain> swapchain; // empty: offscreen
    std::optional<Painter> painter;
};

Canvas::Canvas(Window& window, const gpu::Instance& instance, double textScale, std::filesystem::path shots)
    : window_(window)
    , instance_(instance)
    , shots_(std::move(shots))
    , scale_(textScale)
    , fonts_(loadFonts(textScale)) {
    applyTheme(scale_);
}

Canvas::~Canvas() = default;

void Canvas::open(gpu::Device& device) {
    drop();
    onDevice_ = std::make_unique<OnDevice>(window_, instance_, device);
}

void Canvas::drop() {
    before_ = counts();
    onDevice_.reset();
}

Canvas::Counts Canvas::counts() const {
    Counts all = before_;
    if (onDevice_) {
        all.drawn += onDevice_->painter->drawn();
        all.yielded += onDevice_->painter->yielded();
        all.tiles += onDevice_->painter->tiles();
        all.swapchains += onDevice_->swapchain ? onDevice_->swapchain->remade() : 0;
    }
    return all;
}

void Canvas::draw(const Console& console, bool newSwapchain, std::span<const Layer> layers,
                  const std::function<bool()>& busy) {
    OnDevice& on = *onDevice_;
    if (newSwapchain && on.swapchain) {
        on.swapchain->lose();
    }
    if (on.swapchain && on.swapchain->surfaceLost()) {
        on.renewSurface(window_, instance_);
    }
    if (window_.takeExposed()) {
        on.painter->redraw();
    }
    if (window_.minimised()) {
        return;
    }
    const auto never = [] { return false; };
    if (console.requests.screenshot) { // of this frame, whatever else the device has to do
        on.painter->awaitFrame();
    }
    on.painter->draw(window_.size(), layers, ImGui::GetDrawData(),
                     console.requests.screenshot ? never : busy);
}

void Canvas::finishFrame(Console& console, std::span<const Layer> layers, const std::function<bool()>& busy) {
    ImGui::Render();
    const bool newSwapchain = std::exchange(console.requests.newSwapchain, false);
    try {
        if (onDevice_) {
            draw(console, newSwapchain, layers, busy);
        }
    } catch (const DeviceFailed&) {
        throw;
    } catch (const Error& e) { // what has drawn once may draw again when it is opened again
        if (counts().drawn == 0) {
            throw;
        }
        throw DeviceFailed(e.what());
    }
    console.requests.screenshot = console.requests.screenshot && !shoot(console);
    if (scale_ != console.status.drawnScale) {
        scale_ = console.status.drawnScale;
        fonts_ = loadFonts(scale_);
        applyTheme(scale_);
        if (onDevice_) {
            onDevice_->painter->uploadFonts();
        } else {
            ImGui::GetIO().Fonts->Build(); // so that the next frame measures text with the new font
        }
    }
}

std::unique_ptr<Image> Canvas::frameImage(const Console& console) {
    const int below = captionHeight(static_cast<int>(window_.size().width), console.status.caption.size());
    const bool drawn = onDevice_ && !window_.minimised(); // else finishFrame() drew nothing
    std::unique_ptr<Image> image = drawn ? onDevice_->painter->frameImage(below) : nullptr;
    if (image) {
        drawCaption(*image, image->height() - below, console.status.caption);
    }
    return image;
}

bool Canvas::shoot(Console& console) {
    if (!onDevice_) {
        shotFault_ = "the GPU is lost";
        console.notify("no screenshot: " + shotFault_);
        return true;
    }
    const std::filesystem::path file =
        window_.offscreen() ? shots_ / kOffscreenShot : unusedName(shots_, "screenshot", {".png"}) += ".png";
    try {
        std::error_code ignored; // writing says why a file cannot be made
        std::filesystem::create_directories(shots_, ignored);
        const std::unique_ptr<Image> image = frameImage(console);
        if (!image) {
            if (!std::exchange(waits_, true)) {
                console.notify("screenshot: waits until the window is drawn");
            }
            return false;
        }
        waits_ = false;
        image->writePng(file);
        shotFault_.clear();
        ++console.status.shots;
        console.notify("screenshot " + file.string());
    } catch (const DeviceFailed&) {
        throw;
    } catch (const Error& e) {
        shotFault_ = e.what();
        console.notify(shotFault_);
    }
    return true;
}

} // namespace fathom::operate
