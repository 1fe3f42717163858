// SPDX-License-Identifier: Apache-2.0
// What a driver keeps of compiled pipelines from one start to the next, in a file of the user's cache folder.
// A cache that cannot be read or written costs time at the next start, and nothing else.
#pragma once

#include <filesystem>
#include <span>
#include <vector>
#include <vulkan/vulkan.h>

namespace fathom::gpu {

class PipelineCache {
public:
    // Of a device that outlives it; begins with what the file holds. file: empty = nothing is kept. Throws
    // what check() does when there can be none, not even an empty one.
    PipelineCache(VkDevice device, std::filesystem::path file);
    ~PipelineCache(); // writes the file
    PipelineCache(const PipelineCache&) = delete;
    PipelineCache& operator=(const PipelineCache&) = delete;

    VkPipelineCache handle() const { return handle_; }

private:
    VkResult create(std::span<const char> data);
    void save() const noexcept;

    VkDevice device_;
    std::filesystem::path file_;
    VkPipelineCache handle_ = VK_NULL_HANDLE;
};

// The data in that file; nothing unless they are there as they were stored, to the last bit: drivers need not
// check what they are handed.
std::vector<char> storedPipelines(const std::filesystem::path& file);

// In place of what the file held, in one step, at most 256 MiB. Throws Error, and leaves the file as it was
// and nothing beside it.
void storePipelines(const std::filesystem::path& file, std::span<const char> data);

} // namespace fathom::gpu
