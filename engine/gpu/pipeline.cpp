// SPDX-License-Identifier: Apache-2.0
#include "engine/gpu/pipeline.h"

#include "engine/gpu/result.h"
#include "engine/types/error.h"

#include <utility>

namespace fathom::gpu {

namespace {

uint64_t bytesOfTexel(VkFormat format) {
    switch (format) {
    case VK_FORMAT_R16_UINT:
        return 2;
    case VK_FORMAT_R32_UINT:
    case VK_FORMAT_R8G8B8A8_UINT:
        return 4;
    case VK_FORMAT_R32G32_UINT:
    case VK_FORMAT_R16G16B16A16_UINT:
        return 8;
    case VK_FORMAT_R32G32B32A32_UINT:
    case VK_FORMAT_R32G32B32A32_SFLOAT:
        return 16;
    default:
        throw Error("texel format " + std::to_string(format) + " is not used by any pass");
    }
}

VkShaderModule makeModule(VkDevice device, std::span<const uint32_t> spirv) {
    VkShaderModuleCreateInfo info{VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO};
    info.codeSize = spirv.size_bytes();
    info.pCode = spirv.data();
    VkShaderModule module = VK_NULL_HANDLE;
    check(vkCreateShaderModule(device, &info, nullptr, &module), "vkCreateShaderModule");
    return module;
}

VkDescriptorSetLayout makeSetLayout(VkDevice device, const std::vector<BindingKind>& kinds) {
    std::vector<VkDescriptorSetLayoutBinding> bindings;
    for (const BindingKind& kind : kinds) {
        bindings.push_back(
            {static_cast<uint32_t>(bindings.size()), kind.type, 1, VK_SHADER_STAGE_COMPUTE_BIT, nullptr});
    }
    VkDescriptorSetLayoutCreateInfo info{VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO};
    info.bindingCount = static_cast<uint32_t>(bindings.size());
    info.pBindings = bindings.data();
    VkDescriptorSetLayout layout = VK_NULL_HANDLE;
    check(vkCreateDescriptorSetLayout(device, &info, nullptr, &layout), "vkCreateDescriptorSetLayout");
    return layout;
}

VkPipelineLayout makeLayout(VkDevice device, VkDescriptorSetLayout set, uint32_t pushBytes) {
    const VkPushConstantRange push{VK_SHADER_STAGE_COMPUTE_BIT, 0, pushBytes};
    VkPipelineLayoutCreateInfo info{VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO};
    info.setLayoutCount = 1;
    info.pSetLayouts = &set;
    info.pushConstantRangeCount = pushBytes != 0 ? 1 : 0;
    info.pPushConstantRanges = &push;
    VkPipelineLayout layout = VK_NULL_HANDLE;
    check(vkCreatePipelineLayout(device, &info, nullptr, &layout), "vkCreatePipelineLayout");
    return layout;
}

std::shared_ptr<const CompiledPipeline> compile(const Device& device, const PipelineInfo& info) {
    const auto made =
        std::make_shared<CompiledPipeline>(device.handle()); // on a throw, frees what was created
    made->setLayout = makeSetLayout(device.handle(), info.bindings);
    made->layout = makeLayout(device.handle(), made->setLayout, info.pushBytes);
    std::vector<VkSpecializationMapEntry> entries;
    for (uint32_t i = 0; i < info.constants.size(); ++i) {
        entries.push_back({info.constants[i].id, static_cast<uint32_t>(i * sizeof(Constant) + 4), 4});
    }
    const VkSpecializationInfo special{static_cast<uint32_t>(entries.size()), entries.data(),
                                       info.constants.size() * sizeof(Constant), info.constants.data()};
    VkComputePipelineCreateInfo create{VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO};
    create.layout = made->layout;
    create.stage.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO;
    create.stage.stage = VK_SHADER_STAGE_COMPUTE_BIT;
    create.stage.module = makeModule(device.handle(), info.spirv);
    create.stage.pName = "main";
    create.stage.pSpecializationInfo = &special;
    const VkResult result =
        vkCreateComputePipelines(device.handle(), device.pipelineCache(), 1, &create, nullptr, &made->handle);
    vkDestroyShaderModule(device.handle(), create.stage.module, nullptr);
    check(result, info.name);
    return made;
}

} // namespace

Pipeline::Pipeline(const Device& device, PipelineInfo info)
    : info_(std::move(info)) {
    compiled_ = device.pipelines().find(info_);
    if (compiled_ == nullptr) {
        compiled_ = device.pipelines().keep(info_, compile(device, info_));
    }
}

Bindings::Bindings(const Device& device, const Pipeline& pipeline, const std::vector<const Buffer*>& buffers,
                   const Buffer& unused)
    : Bindings() { // delegates, so that the destructor runs when a later step throws
    device_ = &device;
    const auto count = static_cast<uint32_t>(pipeline.bindings().size());
    if (buffers.size() != count) {
        throw Error(std::string(pipeline.name()) + " has " + std::to_string(count) + " bindings, not " +
                    std::to_string(buffers.size()));
    }
    const VkDescriptorPoolSize sizes[] = {{VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, count},
                                          {VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, 1},
                                          {VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER, count}};
    VkDescriptorPoolCreateInfo pool{VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO};
    pool.maxSets = 1;
    pool.poolSizeCount = 3;
    pool.pPoolSizes = sizes;
    check(vkCreateDescriptorPool(device.handle(), &pool, nullptr, &pool_), "vkCreateDescriptorPool");
    const VkDescriptorSetLayout layout = pipeline.setLayout();
    VkDescriptorSetAllocateInfo allocate{VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO};
    allocate.descriptorPool = pool_;
    allocate.descriptorSetCount = 1;
    allocate.pSetLayouts = &layout;
    check(vkAllocateDescriptorSets(device.handle(), &allocate, &set_), "vkAllocateDescriptorSets");
    write(pipeline, buffers, unused);
}

void Bindings::write(const Pipeline& pipeline, const std::vector<const Buffer*>& buffers,
                     const Buffer& unused) {
    const std::vector<BindingKind>& kinds = pipeline.bindings();
    const auto count = static_cast<uint32_t>(kinds.size());
    std::vector<VkDescriptorBufferInfo> infos(count);
    std::vector<VkWriteDescriptorSet> writes(count, {VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET});
    views_.resize(count, VK_NULL_HANDLE);
    for (uint32_t b = 0; b < count; ++b) {
        const Buffer& buffer = buffers[b] != nullptr && *buffers[b] ? *buffers[b] : unused;
        infos[b] = {buffer.handle(), 0, VK_WHOLE_SIZE};
        if (kinds[b].texels != VK_FORMAT_UNDEFINED) {
            views_[b] = viewOf(buffer, kinds[b].texels, pipeline.name());
        }
        writes[b].dstSet = set_;
        writes[b].dstBinding = b;
        writes[b].descriptorCount = 1;
        writes[b].descriptorType = kinds[b].type;
        writes[b].pBufferInfo = &infos[b];
        writes[b].pTexelBufferView = &views_[b];
    }
    vkUpdateDescriptorSets(device_->handle(), count, writes.data(), 0, nullptr);
}

// Reads beyond the limit of a device are undefined.
std::string texelRefusal(const DeviceFacts& facts, uint64_t bytes, VkFormat format) {
    const uint64_t texels = bytes / bytesOfTexel(format);
    return texels <= facts.maxTexels ? ""
                                     : "a buffer of " + std::to_string(texels) + " texels exceeds the " +
                                           std::to_string(facts.maxTexels) + " of " + facts.name +
                                           "; allowed: smaller images, or another device";
}

VkBufferView Bindings::viewOf(const Buffer& buffer, VkFormat format, const char* pass) {
    const std::string refusal = texelRefusal(device_->facts(), buffer.bytes(), format);
    if (!refusal.empty()) {
        throw Error(std::string("pass ") + pass + ": " + refusal);
    }
    VkBufferViewCreateInfo info{VK_STRUCTURE_TYPE_BUFFER_VIEW_CREATE_INFO};
    info.buffer = buffer.handle();
    info.format = format;
    info.range = VK_WHOLE_SIZE;
    VkBufferView view = VK_NULL_HANDLE;
    check(vkCreateBufferView(device_->handle(), &info, nullptr, &view), "vkCreateBufferView");
    return view;
}

Bindings::~Bindings() {
    if (device_ != nullptr) {
        for (VkBufferView view : views_) {
            vkDestroyBufferView(device_->handle(), view, nullptr);
        }
        vkDestroyDescriptorPool(device_->handle(), pool_, nullptr);
    }
}

void Bindings::swap(Bindings& other) noexcept {
    std::swap(device_, other.device_);
    std::swap(pool_, other.pool_);
    std::swap(set_, other.set_);
    std::swap(views_, other.views_);
}

} // namespace fathom::gpu
