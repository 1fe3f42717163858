// SPDX-License-Identifier: Apache-2.0
#include "apps/operate/panel_backend.h"

#include "apps/operate/frame_texture.h"
#include "engine/gpu/result.h"

#include <backends/imgui_impl_vulkan.h>
#include <imgui.h>

namespace fathom::operate {

using gpu::check;

namespace {

VkRenderPass makePass(VkDevice device) {
    // Loads the attachment, which already contains the images below.
    const VkAttachmentDescription colour{.format = kDrawn,
                                         .samples = VK_SAMPLE_COUNT_1_BIT,
                                         .loadOp = VK_ATTACHMENT_LOAD_OP_LOAD,
                                         .storeOp = VK_ATTACHMENT_STORE_OP_STORE,
                                         .stencilLoadOp = VK_ATTACHMENT_LOAD_OP_DONT_CARE,
                                         .stencilStoreOp = VK_ATTACHMENT_STORE_OP_DONT_CARE,
                                         .initialLayout = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL,
                                         .finalLayout = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL};
    const VkAttachmentReference reference{0, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL};
    const VkSubpassDescription subpass{.pipelineBindPoint = VK_PIPELINE_BIND_POINT_GRAPHICS,
                                       .colorAttachmentCount = 1,
                                       .pColorAttachments = &reference};
    const VkRenderPassCreateInfo info{.sType = VK_STRUCTURE_TYPE_RENDER_PASS_CREATE_INFO,
                                      .attachmentCount = 1,
                                      .pAttachments = &colour,
                                      .subpassCount = 1,
                                      .pSubpasses = &subpass};
    VkRenderPass pass = VK_NULL_HANDLE;
    check(vkCreateRenderPass(device, &info, nullptr, &pass), "vkCreateRenderPass");
    return pass;
}

VkDescriptorPool makeDescriptors(VkDevice device) {
    const VkDescriptorPoolSize size{VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, 4};
    const VkDescriptorPoolCreateInfo info{.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO,
                                          .flags = VK_DESCRIPTOR_POOL_CREATE_FREE_DESCRIPTOR_SET_BIT,
                                          .maxSets = 4,
                                          .poolSizeCount = 1,
                                          .pPoolSizes = &size};
    VkDescriptorPool pool = VK_NULL_HANDLE;
    check(vkCreateDescriptorPool(device, &info, nullptr, &pool), "vkCreateDescriptorPool");
    return pool;
}

} // namespace

PanelBackend::PanelBackend(gpu::Device& device)
    : device_(device) {}

// Delegates, so that the destructor runs when a later step throws.
PanelBackend::PanelBackend(const gpu::Instance& instance, gpu::Device& device)
    : PanelBackend(device) {
    instance_ = instance.handle();
    descriptors_ = makeDescriptors(device.handle());
    pass_ = makePass(device.handle());
}

PanelBackend::~PanelBackend() {
    stop();
    vkDestroyRenderPass(device_.handle(), pass_, nullptr);
    vkDestroyDescriptorPool(device_.handle(), descriptors_, nullptr);
}

void PanelBackend::start() {
    ImGui_ImplVulkan_InitInfo info{};
    info.Instance = instance_;
    info.PhysicalDevice = device_.physical();
    info.Device = device_.handle();
    info.QueueFamily = device_.drawFamily();
    info.Queue = device_.drawQueue();
    info.DescriptorPool = descriptors_;
    info.MinImageCount = info.ImageCount = 2;
    info.CheckVkResultFn = [](VkResult result) { check(result, "drawing of the window's panels"); };
    ImGui_ImplVulkan_Init(&info, pass_);
}

void PanelBackend::stop() {
    if (ImGui::GetIO().BackendRendererUserData != nullptr) {
        ImGui_ImplVulkan_Shutdown();
        vkResetDescriptorPool(device_.handle(), descriptors_, 0);
    }
}

// The backend never frees an old font texture, so the whole backend is restarted.
void PanelBackend::restart(const Once& once) {
    stop();
    start();
#if IMGUI_VERSION_NUM < 19000
    once([](VkCommandBuffer commands) { ImGui_ImplVulkan_CreateFontsTexture(commands); });
    ImGui_ImplVulkan_DestroyFontUploadObjects();
#else
    (void)once;
    device_.withDrawQueue([] { ImGui_ImplVulkan_CreateFontsTexture(); }); // submits and waits by itself
#endif
}

// The panels use one texture, the fonts. Since 1.87 ImGui's commands name it, and those that were made before
// a restart name none, or one that is gone.
void PanelBackend::nameTexture(ImDrawData& data) {
    for (int i = 0; i < data.CmdListsCount; ++i) {
        for (ImDrawCmd& command : data.CmdLists[i]->CmdBuffer) {
            command.TextureId = ImGui::GetIO().Fonts->TexID;
        }
    }
}

void PanelBackend::record(VkCommandBuffer commands, VkFramebuffer framebuffer, VkExtent2D size,
                          ImDrawData* data) const {
    VkRenderPassBeginInfo pass{VK_STRUCTURE_TYPE_RENDER_PASS_BEGIN_INFO};
    pass.renderPass = pass_;
    pass.framebuffer = framebuffer;
    pass.renderArea.extent = size;
    vkCmdBeginRenderPass(commands, &pass, VK_SUBPASS_CONTENTS_INLINE);
    nameTexture(*data);
    ImGui_ImplVulkan_RenderDrawData(data, commands);
    vkCmdEndRenderPass(commands);
}

} // namespace fathom::operate
