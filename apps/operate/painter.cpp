// SPDX-License-Identifier: Apache-2.0
#include "apps/operate/painter.h"

#include "engine/gpu/result.h"
#include "engine/types/error.h"

#include <algorithm>
#include <chrono>
#include <cstring>
#include <thread>
#include <utility>

namespace fathom::operate {

using gpu::check;

namespace {

constexpr uint64_t kLongWait = 10'000'000'000; // [ns] a frame on a busy CPU device can take seconds

} // namespace

Painter::Painter(const gpu::Instance& instance, gpu::Device& device, Swapchain* swapchain, By drawer,
                 EmptyTag)
    : device_(device)
    , swapchain_(swapchain) {
    if (drawer == By::Cpu) {
        host_.emplace(device);
    } else {
        panels_.emplace(instance, device);
    }
}

// Delegates, so that the destructor runs when a later step throws.
Painter::Painter(const gpu::Instance& instance, gpu::Device& device, Swapchain* swapchain, By drawer)
    : Painter(instance, device, swapchain, drawer, EmptyTag{}) {
    const VkCommandPoolCreateInfo pool{VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO, nullptr,
                                       VK_COMMAND_POOL_CREATE_RESET_COMMAND_BUFFER_BIT, device.drawFamily()};
    check(vkCreateCommandPool(device.handle(), &pool, nullptr, &pool_), "vkCreateCommandPool");
    const VkCommandBufferAllocateInfo allocate{.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO,
                                               .commandPool = pool_,
                                               .commandBufferCount = 1};
    check(vkAllocateCommandBuffers(device.handle(), &allocate, &commands_), "vkAllocateCommandBuffers");
    const VkFenceCreateInfo fence{VK_STRUCTURE_TYPE_FENCE_CREATE_INFO, nullptr, VK_FENCE_CREATE_SIGNALED_BIT};
    check(vkCreateFence(device.handle(), &fence, nullptr, &done_), "vkCreateFence");
    const VkSemaphoreCreateInfo semaphore{VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO};
    check(vkCreateSemaphore(device.handle(), &semaphore, nullptr, &ready_), "vkCreateSemaphore");
    uploadFonts();
}

Painter::~Painter() {
    if (inFlight_) { // returns at once on a lost device
        vkWaitForFences(device_.handle(), 1, &done_, VK_TRUE, kLongWait);
    }
    vkDestroyFramebuffer(device_.handle(), framebuffer_, nullptr);
    vkDestroySemaphore(device_.handle(), ready_, nullptr);
    vkDestroyFence(device_.handle(), done_, nullptr);
    vkDestroyCommandPool(device_.handle(), pool_, nullptr);
}

bool Painter::finished(uint64_t patience) {
    if (inFlight_) {
        const VkResult result = vkWaitForFences(device_.handle(), 1, &done_, VK_TRUE, patience);
        if (result == VK_TIMEOUT) {
            return false;
        }
        check(result, "vkWaitForFences");
        inFlight_ = false;
    }
    return true;
}

void Painter::awaitFrame() {
    if (!finished(kLongWait)) {
        throw DeviceFailed("the window: the device did not finish a frame within 10 s");
    }
}

void Painter::once(const std::function<void(VkCommandBuffer)>& body) {
    awaitFrame();
    VkCommandBufferBeginInfo begin{VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO};
    begin.flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT;
    check(vkBeginCommandBuffer(commands_, &begin), "vkBeginCommandBuffer");
    body(commands_);
    check(vkEndCommandBuffer(commands_), "vkEndCommandBuffer");
    submit(false);
    awaitFrame();
}

void Painter::uploadFonts() {
    awaitFrame();
    if (host_) {
        host_->takeFonts();
        return;
    }
    panels_->restart([this](const std::function<void(VkCommandBuffer)>& body) { once(body); });
}

// After a throw the painter still has its old size.
void Painter::resize(VkExtent2D size) {
    if (target_ && target_.size().width == size.width && target_.size().height == size.height) {
        return;
    }
    FrameTexture target(device_, kDrawn, size,
                        VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT |
                            VK_IMAGE_USAGE_TRANSFER_DST_BIT);
    if (!host_) {
        const VkImageView view = target.view();
        const VkFramebufferCreateInfo info{.sType = VK_STRUCTURE_TYPE_FRAMEBUFFER_CREATE_INFO,
                                           .renderPass = panels_->pass(),
                                           .attachmentCount = 1,
                                           .pAttachments = &view,
                                           .width = size.width,
                                           .height = size.height,
                                           .layers = 1};
        VkFramebuffer framebuffer = VK_NULL_HANDLE;
        check(vkCreateFramebuffer(device_.handle(), &info, nullptr, &framebuffer), "vkCreateFramebuffer");
        vkDestroyFramebuffer(device_.handle(), std::exchange(framebuffer_, framebuffer), nullptr);
    }
    target_ = std::move(target); // destroys the old image after its framebuffer
    latest_.filled = latest_.shown = false;
}

bool Painter::yields(const std::function<bool()>& busy) {
    if (!device_.sharesQueue()) {
        return false;
    }
    const auto until = std::chrono::steady_clock::now() + std::chrono::duration<double>(kMaxYield);
    while (busy()) {
        if (std::chrono::steady_clock::now() >= until) {
            ++counts_.yielded;
            return true;
        }
        std::this_thread::sleep_for(std::chrono::microseconds(300));
    }
    return false;
}

bool Painter::draw(VkExtent2D size, std::span<const Layer> layers, ImDrawData* data,
                   const std::function<bool()>& busy) {
    constexpr uint64_t kPatience = 20'000'000; // [ns]
    current_ = false;
    current_ = finished(kPatience) && (host_ || !yields(busy)) && drawNow(size, layers, data);
    counts_.drawn += current_ ? 1 : 0;
    return current_;
}

bool Painter::drawNow(VkExtent2D size, std::span<const Layer> layers, ImDrawData* data) {
    if (swapchain_ != nullptr) {
        if (!swapchain_->fit(size)) {
            return false;
        }
        size = swapchain_->size();
        latest_.shown = latest_.shown && latest_.remade == swapchain_->remade();
    }
    resize(size);
    if (host_) {
        host_->draw(size, layers, *data);
        if (latest_.filled && !host_->changed() && (latest_.shown || swapchain_ == nullptr)) {
            return true;
        }
    }
    const VkImage shown = swapchain_ != nullptr ? swapchain_->acquire(ready_) : VK_NULL_HANDLE;
    if (swapchain_ != nullptr && shown == VK_NULL_HANDLE) {
        return false;
    }
    if (!host_) {
        stage(layers);
    }
    record(layers, data, shown);
    submit(shown != VK_NULL_HANDLE);
    if (shown != VK_NULL_HANDLE) {
        swapchain_->show();
        latest_.remade = swapchain_->remade();
        latest_.shown = true;
    }
    return true;
}

void Painter::stage(std::span<const Layer> layers) {
    for (size_t i = 0; i < std::min(layers.size(), kMaxLayers); ++i) {
        const Layer& layer = layers[i];
        Staged& staged = staged_[i];
        staged.fresh = !layer.pixels.empty();
        if (!staged.fresh) {
            continue;
        }
        if (!staged.image || staged.image.size().width != layer.width ||
            staged.image.size().height != layer.height) {
            gpu::Buffer staging(device_, layer.pixels.size_bytes(), gpu::MemoryKind::Upload, "view");
            staged.image = FrameTexture(device_, kImage, {layer.width, layer.height},
                                        VK_IMAGE_USAGE_TRANSFER_SRC_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT);
            staged.staging = std::move(staging);
        }
        std::memcpy(staged.staging.as<uint32_t>().data(), layer.pixels.data(), layer.pixels.size_bytes());
    }
}

void Painter::submit(bool onSurface) {
    check(vkResetFences(device_.handle(), 1, &done_), "vkResetFences");
    VkSubmitInfo info{VK_STRUCTURE_TYPE_SUBMIT_INFO};
    const VkPipelineStageFlags stage = VK_PIPELINE_STAGE_ALL_COMMANDS_BIT;
    const VkSemaphore filled = onSurface ? swapchain_->filled() : VK_NULL_HANDLE;
    if (onSurface) {
        info.waitSemaphoreCount = info.signalSemaphoreCount = 1;
        info.pWaitSemaphores = &ready_;
        info.pWaitDstStageMask = &stage;
        info.pSignalSemaphores = &filled;
    }
    info.commandBufferCount = 1;
    info.pCommandBuffers = &commands_;
    device_.submitDrawing(info, done_);
    inFlight_ = true;
}

} // namespace fathom::operate
