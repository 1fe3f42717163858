// SPDX-License-Identifier: Apache-2.0
#include "engine/cycle/contact_cycle.h"

#include <algorithm>

namespace fathom {

namespace {

constexpr double kNothingToTouch = 1000.0; // [m] certified where no region exists: the tool may go anywhere

} // namespace

ContactCycle::ContactCycle(gpu::Device& device, const Plan& plan, const PatchLayout& layout,
                           cloud::FixturePool& pool, const Tool& tool, double reach, const ArmRig* arm)
    : tool_(tool)
    , arm_(arm)
    , reach_(reach)
    , where_(plan.query) {
    if (where_ == Plan::Query::Gpu) {
        gpu_.emplace(device, plan, layout, pool, tool);
    }
}

void ContactCycle::query(const cloud::FixtureSet& set, const ToolPlace& place, ContactSet& out) {
    if (arm_ != nullptr) { // its leaves are in the base frame already
        ask(arm_->toolAt(place.arm), set, Pose{}, out);
    } else {
        ask(tool_, set, place.pose, out);
    }
}

void ContactCycle::ask(const Tool& tool, const cloud::FixtureSet& set, const Pose& baseTtool,
                       ContactSet& out) {
    switch (where_) {
    case Plan::Query::None:
        fillContactSet(tool, baseTtool, kNothingToTouch, set.host, {}, out);
        out.pairBegin.assign(tool.leafCount() + 1, 0);
        out.pairBandEnd.assign(tool.leafCount() * ContactSet::kGapBands, 0);
        return;
    case Plan::Query::Cpu:
        cpu_.query(tool, baseTtool, reach_, set.host, set.grid, out);
        break;
    case Plan::Query::Gpu: {
        const auto onDevice = [&](const PosedLeaves& leaves, float reach, std::vector<uint32_t>& found) {
            const bool fits = gpu_->cull(set, leaves, baseTtool, reach, found);
            if (!fits) {
                gpu_->grow(); // the next query has room; this one tries again with what the loop decides
            }
            return fits;
        };
        gpuLoop_.run(tool, baseTtool, reach_, set.host, set.grid.maxRadius(), onDevice, out);
        break;
    }
    }
    behind_.update(tool, set.host, set.grid.maxRadius(), out);
}

QueryStatistics ContactCycle::statistics() const {
    return where_ == Plan::Query::Gpu ? gpuLoop_.statistics() : cpu_.statistics();
}

} // namespace fathom
