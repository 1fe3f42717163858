// SPDX-License-Identifier: Apache-2.0
// Keeps the driver's pipeline cache between starts, in a file in the user's cache folder. If the file cannot
// be read or written, the next start takes longer.
#pragma once

#include <filesystem>
#include <span>
#include <vector>
#include <vulkan/vulkan.h>

namespace fathom::gpu {

class PipelineCache {
public:
    // Starts with the contents of the file. The device must outlive the cache. file: empty = the cache is not
    // stored. Throws like check() when the driver cannot even create an empty cache.
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

// Reads the data of the file. Empty unless the checksum fits, because drivers need not check cache data.
std::vector<char> storedPipelines(const std::filesystem::path& file);

// Replaces the file atomically, at most 256 MiB. If it throws Error, the file is unchanged and no temporary
// file remains.
void storePipelines(const std::filesystem::path& file, std::span<const char> data);

} // namespace fathom::gpu
