// SPDX-License-Identifier: Apache-2.0
#include "engine/gpu/pipeline_store.h"

#include <algorithm>

namespace fathom::gpu {

CompiledPipeline::~CompiledPipeline() {
    vkDestroyPipeline(device, handle, nullptr);
    vkDestroyPipelineLayout(device, layout, nullptr);
    vkDestroyDescriptorSetLayout(device, setLayout, nullptr);
}

// The mutex is held.
std::shared_ptr<const CompiledPipeline> PipelineStore::findHeld(const PipelineKey& key) {
    const auto found =
        std::find_if(entries_.begin(), entries_.end(), [&](const Entry& e) { return e.key == key; });
    if (found == entries_.end()) {
        return nullptr;
    }
    std::rotate(found, found + 1, entries_.end());
    return entries_.back().compiled;
}

std::shared_ptr<const CompiledPipeline> PipelineStore::find(const PipelineKey& key) {
    const std::lock_guard lock(mutex_);
    return findHeld(key);
}

std::shared_ptr<const CompiledPipeline>
PipelineStore::keep(PipelineKey key, std::shared_ptr<const CompiledPipeline> compiled) {
    const std::lock_guard lock(mutex_);
    if (auto there = findHeld(key)) {
        return there;
    }
    entries_.push_back({std::move(key), compiled});
    for (auto e = entries_.begin(); e != entries_.end() && entries_.size() > kMost;) {
        e = e->compiled.use_count() == 1 ? entries_.erase(e) : e + 1; // its own count alone: nobody uses it
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
