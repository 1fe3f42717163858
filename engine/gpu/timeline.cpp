// SPDX-License-Identifier: Apache-2.0
#include "engine/gpu/timeline.h"

#include "engine/gpu/result.h"
#include "engine/types/clock.h"

#include <chrono>
#include <thread>

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

uint64_t Timeline::value() const noexcept {
    uint64_t reached = 0;
    return vkGetSemaphoreCounterValue(device_.handle(), handle_, &reached) == VK_SUCCESS ? reached : 0;
}

bool Timeline::comesSoon(uint64_t value) const {
    const auto until = Clock::now() + std::chrono::duration<double>(kPollTime);
    do {
        if (this->value() >= value) {
            return true;
        }
    } while (Clock::now() < until);
    return false;
}

void Timeline::wait(uint64_t value) const {
    // On a CPU device polling would take a processor from the passes.
    if (device_.facts().kind != DeviceKind::Cpu && comesSoon(value)) {
        return;
    }
    VkSemaphoreWaitInfo info{VK_STRUCTURE_TYPE_SEMAPHORE_WAIT_INFO};
    info.semaphoreCount = 1;
    info.pSemaphores = &handle_;
    info.pValues = &value;
    VkResult result = vkWaitSemaphores(device_.handle(), &info, UINT64_MAX);
    // The device still uses what a caller would free.
    while (result == VK_ERROR_OUT_OF_HOST_MEMORY || result == VK_ERROR_OUT_OF_DEVICE_MEMORY) {
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
        result = vkWaitSemaphores(device_.handle(), &info, UINT64_MAX);
    }
    check(result, "vkWaitSemaphores");
}

} // namespace fathom::gpu
