// SPDX-License-Identifier: Apache-2.0
#include "engine/gpu/stopwatch.h"

#include "engine/gpu/result.h"

namespace fathom::gpu {

uint64_t stampsBetween(uint64_t from, uint64_t to, uint32_t bits) noexcept {
    const uint64_t range = bits < 64 ? (uint64_t{1} << bits) - 1 : ~uint64_t{0};
    const uint64_t counts = (to - from) & range;
    return counts <= range / 2 ? counts : 0;
}

Stopwatch::Stopwatch(const Device& device, uint32_t marks)
    : device_(device)
    , capacity_(marks) {
    if (device.facts().timestampPeriodNs <= 0.0) {
        return;
    }
    VkQueryPoolCreateInfo info{VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO};
    info.queryType = VK_QUERY_TYPE_TIMESTAMP;
    info.queryCount = marks;
    check(vkCreateQueryPool(device.handle(), &info, nullptr, &pool_), "vkCreateQueryPool");
}

Stopwatch::~Stopwatch() {
    vkDestroyQueryPool(device_.handle(), pool_, nullptr);
}

void Stopwatch::reset() {
    used_ = 0;
    resetForResubmit();
}

void Stopwatch::resetForResubmit() const {
    if (supported()) {
        vkResetQueryPool(device_.handle(), pool_, 0, capacity_);
    }
}

void Stopwatch::mark(VkCommandBuffer commands) {
    markAt(commands, VK_PIPELINE_STAGE_BOTTOM_OF_PIPE_BIT);
}

void Stopwatch::markReached(VkCommandBuffer commands) {
    markAt(commands, VK_PIPELINE_STAGE_TOP_OF_PIPE_BIT);
}

void Stopwatch::markAt(VkCommandBuffer commands, VkPipelineStageFlagBits stage) {
    if (used_ < capacity_) {
        if (supported()) {
            vkCmdWriteTimestamp(commands, stage, pool_, used_);
        }
        ++used_;
    }
}

std::vector<double> Stopwatch::intervalsMs() const {
    std::vector<double> intervals(used_ > 0 ? used_ - 1 : 0, 0.0);
    if (!supported() || used_ < 2) {
        return intervals;
    }
    std::vector<uint64_t> stamps(used_);
    check(vkGetQueryPoolResults(device_.handle(), pool_, 0, used_, stamps.size() * 8, stamps.data(), 8,
                                VK_QUERY_RESULT_64_BIT | VK_QUERY_RESULT_WAIT_BIT),
          "vkGetQueryPoolResults");
    for (size_t i = 0; i < intervals.size(); ++i) {
        intervals[i] =
            static_cast<double>(stampsBetween(stamps[i], stamps[i + 1], device_.facts().timestampBits)) *
            device_.facts().timestampPeriodNs * 1e-6;
    }
    return intervals;
}

} // namespace fathom::gpu
