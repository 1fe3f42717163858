// SPDX-License-Identifier: Apache-2.0
#include "engine/cloud/device_query.h"

namespace fathom::cloud {

DeviceQuery::DeviceQuery(gpu::Device& device, const Plan& plan, const PatchLayout& layout, FixturePool& pool,
                         const gpu::PipelineInfo& pipeline)
    : device_(device)
    , layout_(layout)
    , pool_(pool)
    , hold_(plan.hold)
    , pipeline_(device, pipeline)
    , run_(device)
    , leaves_(device)
    , frozen_(device) {}

void DeviceQuery::setTool(const Tool& tool) {
    if (leaves_.fill(tool)) {
        bindings_.clear();
    }
}

std::vector<const gpu::Buffer*> DeviceQuery::inputsOf(const SetBuffers& set) const {
    return {&leaves_.buffer(), &set.nodes, &set.spheres, &set.held, &set.classes};
}

} // namespace fathom::cloud
