// SPDX-License-Identifier: Apache-2.0
#include "engine/gpu/pipeline.h"

#include "engine/gpu/result.h"
#include "engine/types/error.h"

#include <utility>

namespace fathom::gpu {

namespace {

VkShaderModule makeModule(VkDevice device, std::span<const uint32_t> spirv) {
    VkShaderModuleCreateInfo info{VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO};
    info.codeSize = spirv.size_bytes();
    info.pCode = spirv.data();
    VkShaderModule module = VK_NULL_HANDLE;
    check(vkCreateShaderModule(device, &info, nullptr, &module), "vkCreateShaderModule");
    return module;
}

VkDescriptorSetLayout makeSetLayout(VkDevice device, const std::vector<VkDescriptorType>& types) {
    std::vector<VkDescriptorSetLayoutBinding> bindings;
    for (const VkDescriptorType type : types) {
        bindings.push_back(
            {static_cast<uint32_t>(bindings.size()), type, 1, VK_SHADER_STAGE_COMPUTE_BIT, nullptr});
    }
    VkDescriptorSetLayoutCreateInfo info{VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO};
    info.bindingCount = static_cast<uint32_t>(bindings.size());
    info.pBindings = bindings.data();
    VkDescriptorSetLayout layout = VK_NULL_HANDLE;
    check(vkCreateDescriptorSetLayout(device, &info, nullptr, &layout), "vkCreateDescriptorSetLayout");
    return layout;
}

std::vector<VkDescriptorType> typesOf(const PipelineInfo& info) {
    std::vector<VkDescriptorType> types(info.bindings, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER);
    if (info.uniform) {
        types.at(0) = VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER;
    }
    for (const Texels& t : info.texels) {
        types.at(t.binding) = VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER;
    }
    return types;
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

std::shared_ptr<const CompiledPipeline> compile(const Device& device, const PipelineInfo& info,
                                                const std::vector<VkDescriptorType>& types) {
    const auto made = std::make_shared<CompiledPipeline>(device.handle()); // goes with what it has by then
    made->setLayout = makeSetLayout(device.handle(), types);
    made->layout = makeLayout(device.handle(), made->setLayout, info.pushBytes);
    std::vector<VkSpecializationMapEntry> entries;
    for (uint32_t i = 0; i < info.constants.size(); ++i) {
        entries.push_back({i, i * 4, 4});
    }
    const VkSpecializationInfo special{static_cast<uint32_t>(entries.size()), entries.data(),
                                       info.constants.size_bytes(), info.constants.data()};
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

PipelineKey keyOf(const PipelineInfo& info) {
    PipelineKey key{info.spirv.data(),
                    info.spirv.size(),
                    info.bindings,
                    info.pushBytes,
                    info.uniform,
                    {info.constants.begin(), info.constants.end()},
                    {}};
    for (const Texels& t : info.texels) {
        key.texels.emplace_back(t.binding, t.format);
    }
    return key;
}

} // namespace

Pipeline::Pipeline(const Device& device, const PipelineInfo& info)
    : bindings_(info.bindings)
    , pushBytes_(info.pushBytes)
    , groupSize_(info.constants.empty() ? 1 : info.constants[0])
    , types_(typesOf(info))
    , formats_(info.bindings, VK_FORMAT_UNDEFINED)
    , name_(info.name) {
    for (const Texels& t : info.texels) {
        formats_.at(t.binding) = t.format;
    }
    PipelineKey key = keyOf(info);
    compiled_ = device.pipelines().find(key);
    if (compiled_ == nullptr) {
        compiled_ = device.pipelines().keep(std::move(key), compile(device, info, types_));
    }
}

Bindings::Bindings(const Device& device, const Pipeline& pipeline,
                   std::initializer_list<const Buffer*> buffers, const Buffer& unused)
    : device_(&device) {
    if (buffers.size() != pipeline.bindings()) {
        throw Error(pipeline.name() + " has " + std::to_string(pipeline.bindings()) + " bindings, not " +
                    std::to_string(buffers.size()));
    }
    const VkDescriptorPoolSize sizes[] = {{VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, pipeline.bindings()},
                                          {VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, 1},
                                          {VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER, pipeline.bindings()}};
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

    std::vector<VkDescriptorBufferInfo> infos;
    for (const Buffer* buffer : buffers) {
        const Buffer& real = buffer != nullptr && *buffer ? *buffer : unused;
        const VkFormat format = pipeline.texelsOf(static_cast<uint32_t>(infos.size()));
        infos.push_back({real.handle(), 0, VK_WHOLE_SIZE});
        views_.push_back(format != VK_FORMAT_UNDEFINED ? viewOf(real, format) : VK_NULL_HANDLE);
    }
    std::vector<VkWriteDescriptorSet> writes;
    for (uint32_t b = 0; b < infos.size(); ++b) {
        VkWriteDescriptorSet write{VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET};
        write.dstSet = set_;
        write.dstBinding = b;
        write.descriptorCount = 1;
        write.descriptorType = pipeline.typeOf(b);
        write.pBufferInfo = &infos[b];
        write.pTexelBufferView = &views_[b];
        writes.push_back(write);
    }
    vkUpdateDescriptorSets(device.handle(), static_cast<uint32_t>(writes.size()), writes.data(), 0, nullptr);
}

VkBufferView Bindings::viewOf(const Buffer& buffer, VkFormat format) {
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
