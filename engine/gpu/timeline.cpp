// SPDX-License-Identifier: Apache-2.0
#include "engine/gpu/timeline.h"

#include "engine/gpu/result.h"

namespace fathom::gpu {

Timeline::Timeline(const Device& device)
    : device_(device) {
    VkSemaphoreTypeCreateInfo type{VK_STRUCTURE_TYPE_SEMAPHORE_TYPE_CREATE_INFO};
    type.semaphoreType = VK_SEMAPHORE_TYPE_TIMELINE;
    VkSemaphoreCreateInfo info{VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO};
    info.pNext = &type;
    check(vkCreateSemaphore(device.handle(), &info, nullptr, &handle_), "vkCreateSemaphore");
}

Timeline::~Timeline() {
    vkDestroySemaphore(device_.handle(), handle_, nullptr);
}

uint64_t Timeline::value() const {
    uint64_t reached = 0;
    check(vkGetSemaphoreCounterValue(device_.handle(), handle_, &reached), "vkGetSemaphoreCounterValue");
    return reached;
}

void Timeline::wait(uint64_t value) const {
    VkSemaphoreWaitInfo info{VK_STRUCTURE_TYPE_SEMAPHORE_WAIT_INFO};
    info.semaphoreCount = 1;
    info.pSemaphores = &handle_;
    info.pValues = &value;
    check(vkWaitSemaphores(device_.handle(), &info, UINT64_MAX), "vkWaitSemaphores");
}

} // namespace fathom::gpu
