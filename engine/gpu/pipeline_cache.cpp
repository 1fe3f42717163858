// SPDX-License-Identifier: Apache-2.0
#include "engine/gpu/pipeline_cache.h"

#include "engine/gpu/result.h"
#include "engine/types/error.h"
#include "engine/types/log.h"
#include "engine/types/read_file.h"

#include <array>
#include <atomic>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <optional>
#include <string>
#include <unistd.h>

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

// FNV-1a, 64 bits: detects truncated or damaged files, not manipulation.
uint64_t sumOf(std::span<const char> data) {
    uint64_t sum = 0xcbf29ce484222325u;
    for (const char c : data) {
        sum = (sum ^ static_cast<unsigned char>(c)) * 0x100000001b3u;
    }
    return sum;
}

// A temporary name in the same folder, unique to this process and call.
fs::path freshBeside(const fs::path& file) {
    static std::atomic<uint32_t> count{0};
    return file.string() + "." + std::to_string(::getpid()) + "." + std::to_string(count++) + ".new";
}

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
        head.sum != sumOf(data)) {
        return {};
    }
    return {data.begin(), data.end()};
}

void storePipelines(const fs::path& file, std::span<const char> data) {
    if (data.size() > kMaxBytes) {
        throw Error(file.string() + ": " + std::to_string(data.size()) + " bytes are too many");
    }
    const Head head{kMagic, data.size(), sumOf(data)};
    const fs::path fresh = freshBeside(file);
    std::error_code failed;
    fs::create_directories(file.parent_path(), failed);
    std::ofstream out(fresh, std::ios::binary);
    out.write(reinterpret_cast<const char*>(&head), sizeof head);
    out.write(data.data(), static_cast<std::streamsize>(data.size()));
    out.close(); // writes the remaining bytes; may fail on a full disk
    if (out) {
        fs::rename(fresh, file, failed);
    }
    if (!out || failed) {
        const std::string why = out ? failed.message() : "cannot be written whole";
        fs::remove(fresh, failed);
        throw Error(file.string() + ": " + why);
    }
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
