// SPDX-License-Identifier: Apache-2.0
#include "engine/gpu/pipeline_store.h"

#include <algorithm>

namespace fathom::gpu {

CompiledPipeline::~CompiledPipeline() {
    vkDestroyPipeline(device, handle, nullptr);
    vkDestroyPipelineLayout(device, layout, nullptr);
    vkDestroyDescriptorSetLayout(device, setLayout, nullptr);
}

// Requires the mutex.
std::shared_ptr<const CompiledPipeline> PipelineStore::findLocked(const PipelineInfo& info) {
    const auto found = std::ranges::find_if(entries_, [&](const Entry& e) { return e.info.sameCode(info); });
    if (found == entries_.end()) {
        return nullptr;
    }
    std::rotate(found, found + 1, entries_.end());
    return entries_.back().compiled;
}

std::shared_ptr<const CompiledPipeline> PipelineStore::find(const PipelineInfo& info) {
    const std::lock_guard lock(mutex_);
    return findLocked(info);
}

std::shared_ptr<const CompiledPipeline>
PipelineStore::keep(PipelineInfo info, std::shared_ptr<const CompiledPipeline> compiled) {
    const std::lock_guard lock(mutex_);
    if (auto first = findLocked(info)) {
        return first;
    }
    entries_.push_back({std::move(info), compiled});
    for (auto e = entries_.begin(); e != entries_.end() && entries_.size() > kMax;) {
        e = e->compiled.use_count() == 1 ? entries_.erase(e) : e + 1; // the store is the only owner
    }
    return compiled;
}

void PipelineStore::clear() {
    const std::lock_guard lock(mutex_);
    entries_.clear();
}

size_t PipelineStore::size() const {
    const std::lock_guard lock(mutex_);
    return entries_.size();
}

} // namespace fathom::gpu
