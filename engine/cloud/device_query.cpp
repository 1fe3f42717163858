// SPDX-License-Identifier: Apache-2.0
#include "engine/cloud/device_query.h"

namespace fathom::cloud {

DeviceQuery::DeviceQuery(const QueryContext& context, const gpu::PipelineInfo& pipeline)
    : device_(*context.device)
    , layout_(context.layout)
    , pool_(context.pool)
    , hold_(context.plan.hold)
    , pipeline_(device_, pipeline)
    , run_(device_)
    , leaves_(device_)
    , frozen_(device_) {}

void DeviceQuery::setTool(const Tool& tool) {
    if (leaves_.fill(tool)) {
        bindings_.clear();
    }
}

std::vector<const gpu::Buffer*> DeviceQuery::inputsOf(const SetBuffers& set) const {
    return {&leaves_.buffer(), &set.nodes, &set.spheres, &set.held, &set.classes};
}

} // namespace fathom::cloud
