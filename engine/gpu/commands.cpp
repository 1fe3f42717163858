// SPDX-License-Identifier: Apache-2.0
#include "engine/gpu/commands.h"

#include "engine/gpu/result.h"

#include <vector>

namespace fathom::gpu {

namespace {

constexpr VkPipelineStageFlags kWork = VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT | VK_PIPELINE_STAGE_TRANSFER_BIT;
constexpr VkAccessFlags kAccess = VK_ACCESS_UNIFORM_READ_BIT | VK_ACCESS_SHADER_READ_BIT |
                                  VK_ACCESS_SHADER_WRITE_BIT | VK_ACCESS_TRANSFER_READ_BIT |
                                  VK_ACCESS_TRANSFER_WRITE_BIT;

} // namespace

Commands::Commands(const Device& device, EmptyTag)
    : device_(device) {}

// Delegates, so that the destructor runs when a later step throws.
Commands::Commands(const Device& device)
    : Commands(device, EmptyTag{}) {
    VkCommandPoolCreateInfo pool{VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO};
    pool.queueFamilyIndex = device.queueFamily();
    check(vkCreateCommandPool(device.handle(), &pool, nullptr, &pool_), "vkCreateCommandPool");
    VkCommandBufferAllocateInfo allocate{VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO};
    allocate.commandPool = pool_;
    allocate.level = VK_COMMAND_BUFFER_LEVEL_PRIMARY;
    allocate.commandBufferCount = 1;
    check(vkAllocateCommandBuffers(device.handle(), &allocate, &handle_), "vkAllocateCommandBuffers");
}

Commands::~Commands() {
    vkDestroyCommandPool(device_.handle(), pool_, nullptr);
}

void Commands::begin(Submissions submissions) {
    check(vkResetCommandPool(device_.handle(), pool_, 0), "vkResetCommandPool");
    VkCommandBufferBeginInfo info{VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO};
    info.flags = submissions == Submissions::One
                     ? VkCommandBufferUsageFlags{VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT}
                     : 0;
    check(vkBeginCommandBuffer(handle_, &info), "vkBeginCommandBuffer");
    dispatches_ = 0;
    barrier();
}

void Commands::end() {
    barrier(VK_PIPELINE_STAGE_HOST_BIT, VK_ACCESS_HOST_READ_BIT | VK_ACCESS_HOST_WRITE_BIT);
    check(vkEndCommandBuffer(handle_), "vkEndCommandBuffer");
}

void Commands::bind(const Pipeline& pipeline, const Bindings& bindings, const void* push) {
    const VkDescriptorSet set = bindings.handle();
    vkCmdBindPipeline(handle_, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline.handle());
    vkCmdBindDescriptorSets(handle_, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline.layout(), 0, 1, &set, 0,
                            nullptr);
    if (push != nullptr) {
        vkCmdPushConstants(handle_, pipeline.layout(), VK_SHADER_STAGE_COMPUTE_BIT, 0, pipeline.pushBytes(),
                           push);
    }
    ++dispatches_;
}

void Commands::dispatch(const Pipeline& pipeline, const Bindings& bindings,
                        const std::array<uint32_t, 3>& groups, const void* push) {
    bind(pipeline, bindings, push);
    vkCmdDispatch(handle_, groups[0], groups[1], groups[2]);
}

void Commands::dispatchIndirect(const Pipeline& pipeline, const Bindings& bindings, const Buffer& arguments,
                                uint64_t offset, const void* push) {
    bind(pipeline, bindings, push);
    vkCmdDispatchIndirect(handle_, arguments.handle(), offset);
}

void Commands::fill(const Buffer& buffer, uint32_t value) {
    vkCmdFillBuffer(handle_, buffer.handle(), 0, VK_WHOLE_SIZE, value);
}

void Commands::update(const Buffer& buffer, uint64_t offset, uint64_t bytes, const void* data) {
    vkCmdUpdateBuffer(handle_, buffer.handle(), offset, bytes, data);
}

void Commands::copy(const Buffer& from, const Buffer& to, uint64_t bytes) {
    const VkBufferCopy region{0, 0, bytes};
    vkCmdCopyBuffer(handle_, from.handle(), to.handle(), 1, &region);
}

void Commands::copyParts(const Buffer& from, const Buffer& to,
                         std::span<const std::pair<uint64_t, uint64_t>> parts) {
    std::vector<VkBufferCopy> regions;
    for (const auto& [offset, bytes] : parts) {
        regions.push_back({offset, offset, bytes});
    }
    vkCmdCopyBuffer(handle_, from.handle(), to.handle(), static_cast<uint32_t>(regions.size()),
                    regions.data());
}

void Commands::barrier() {
    barrier(kWork, kAccess);
}

void Commands::barrierBeforeIndirect() {
    barrier(kWork | VK_PIPELINE_STAGE_DRAW_INDIRECT_BIT, kAccess | VK_ACCESS_INDIRECT_COMMAND_READ_BIT);
}

void Commands::barrier(VkPipelineStageFlags to, VkAccessFlags access) {
    VkMemoryBarrier all{VK_STRUCTURE_TYPE_MEMORY_BARRIER};
    all.srcAccessMask = VK_ACCESS_SHADER_WRITE_BIT | VK_ACCESS_TRANSFER_WRITE_BIT;
    all.dstAccessMask = access;
    // Also waits for earlier reads, because later commands may write to the same buffers. Indirect arguments
    // are read before the shaders start.
    vkCmdPipelineBarrier(handle_, kWork, to, 0, 1, &all, 0, nullptr, 0, nullptr);
}

} // namespace fathom::gpu
