// SPDX-License-Identifier: Apache-2.0
// Records one submission: begin, dispatch, barrier, ..., end.
#pragma once

#include "engine/gpu/pipeline.h"
#include "engine/gpu/timeline.h"

#include <array>
#include <span>
#include <utility>

namespace fathom::gpu {

// How often a recording is submitted.
enum class Submissions { One, Many };

// One thread at a time. Record again for each submission, or once for many; the previous submission must have
// completed.
class Commands {
public:
    explicit Commands(const Device& device);
    ~Commands();
    Commands(const Commands&) = delete;
    Commands& operator=(const Commands&) = delete;

    VkCommandBuffer handle() const { return handle_; }
    uint32_t dispatches() const { return dispatches_; } // recorded since begin()

    // Starts with a global memory barrier, because Vulkan does not prevent hazards between submissions.
    void begin(Submissions submissions = Submissions::One);
    void end();

    // groups: work groups in x, or in x, y and z. push: Pipeline::pushBytes bytes of push constants, copied
    // by the call.
    void dispatch(const Pipeline& pipeline, const Bindings& bindings, uint32_t groups,
                  const void* push = nullptr) {
        dispatch(pipeline, bindings, {groups, 1, 1}, push);
    }
    void dispatch(const Pipeline& pipeline, const Bindings& bindings, const std::array<uint32_t, 3>& groups,
                  const void* push = nullptr);
    // Groups are read from `arguments` on the device: three uint32_t from `offset` [bytes].
    void dispatchIndirect(const Pipeline& pipeline, const Bindings& bindings, const Buffer& arguments,
                          uint64_t offset, const void* push = nullptr);
    void fill(const Buffer& buffer, uint32_t value);                                      // the whole buffer
    void update(const Buffer& buffer, uint64_t offset, uint64_t bytes, const void* data); // at most 64 KiB
    void copy(const Buffer& from, const Buffer& to, uint64_t bytes);
    // Parts of a buffer to the same places of another: offset and size of each [bytes].
    void copyParts(const Buffer& from, const Buffer& to,
                   std::span<const std::pair<uint64_t, uint64_t>> parts);
    // Makes earlier writes visible to later commands, but not to the host (see end()) or to reads of indirect
    // arguments: including either would double the cost of the barrier on a GPU.
    void barrier();
    void barrierBeforeIndirect(); // also covers the arguments of dispatchIndirect()

private:
    struct EmptyTag {}; // creates nothing on the device
    Commands(const Device& device, EmptyTag);
    void barrier(VkPipelineStageFlags to, VkAccessFlags access);
    void bind(const Pipeline& pipeline, const Bindings& bindings, const void* push);

    const Device& device_;
    VkCommandPool pool_ = VK_NULL_HANDLE;
    VkCommandBuffer handle_ = VK_NULL_HANDLE;
    uint32_t dispatches_ = 0;
};

} // namespace fathom::gpu
