// SPDX-License-Identifier: Apache-2.0
#include "engine/gpu/pipeline_cache.h"

#include "engine/gpu/result.h"
#include "engine/types/cache_file.h"
#include "engine/types/error.h"
#include "engine/types/log.h"
#include "engine/types/read_file.h"

#include <array>
#include <cstdint>
#include <cstring>
#include <optional>
#include <string>

namespace fathom::gpu {

namespace {

namespace fs = std::filesystem;

constexpr size_t kMaxBytes = size_t{256} << 20;
constexpr std::array<char, 8> kMagic{'f', 'a', 't', 'h', 'o', 'm', 'P', '1'};

// File header. Byte order is the machine's, because the file is used only on this machine.
struct Head {
    std::array<char, 8> magic = kMagic;
    uint64_t bytes = 0;
    uint64_t sum = 0;
};

} // namespace

std::vector<char> storedPipelines(const fs::path& file) {
    const std::optional<std::string> text = readFileAtMost(file, sizeof(Head) + kMaxBytes);
    Head head;
    if (!text || text->size() < sizeof head) {
        return {};
    }
    std::memcpy(&head, text->data(), sizeof head);
    const std::span<const char> data = std::span(*text).subspan(sizeof head);
    if (head.magic != kMagic || head.bytes != data.size() || data.size() > kMaxBytes ||
        head.sum != fnv1a({data.data(), data.size()})) {
        return {};
    }
    return {data.begin(), data.end()};
}

void storePipelines(const fs::path& file, std::span<const char> data) {
    if (data.size() > kMaxBytes) {
        throw Error(file.string() + ": " + std::to_string(data.size()) + " bytes are too many");
    }
    const Head head{kMagic, data.size(), fnv1a({data.data(), data.size()})};
    std::string bytes(sizeof head, '\0');
    std::memcpy(bytes.data(), &head, sizeof head);
    storeCacheFile(file, bytes.append(data.data(), data.size()));
}

PipelineCache::PipelineCache(VkDevice device, fs::path file)
    : device_(device)
    , file_(std::move(file)) {
    const std::vector<char> data = file_.empty() ? std::vector<char>() : storedPipelines(file_);
    if (data.empty() ||
        create(data) != VK_SUCCESS) { // start empty: a driver would reject this data at every start
        check(create({}), "vkCreatePipelineCache");
    }
}

PipelineCache::~PipelineCache() {
    save();
    vkDestroyPipelineCache(device_, handle_, nullptr);
}

VkResult PipelineCache::create(std::span<const char> data) {
    VkPipelineCacheCreateInfo info{VK_STRUCTURE_TYPE_PIPELINE_CACHE_CREATE_INFO};
    info.initialDataSize = data.size();
    info.pInitialData = data.data();
    return vkCreatePipelineCache(device_, &info, nullptr, &handle_);
}

void PipelineCache::save() const noexcept {
    size_t size = 0;
    if (file_.empty() || vkGetPipelineCacheData(device_, handle_, &size, nullptr) != VK_SUCCESS ||
        size == 0) {
        return;
    }
    try {
        std::vector<char> data(size);
        if (vkGetPipelineCacheData(device_, handle_, &size, data.data()) == VK_SUCCESS) {
            storePipelines(file_, std::span(data).first(size));
        }
    } catch (const std::exception& e) {
        log::debug("pipeline cache not kept: {}", e.what());
    }
}

} // namespace fathom::gpu
