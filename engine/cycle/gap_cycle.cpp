// SPDX-License-Identifier: Apache-2.0
#include "engine/cycle/gap_cycle.h"

namespace fathom {

void GapCycle::use(const cloud::QueryContext& context) {
    gpu_.reset();
    context_.emplace(context);
}

void GapCycle::dropDevice() {
    gpu_.reset();
    context_.reset();
}

void GapCycle::find(const cloud::FixtureSet& set, const Tool& tool, std::span<const Pose> baseTtool,
                    std::vector<SmallestGap>& out) {
    const bool gone = !context_ || !set.device.nodes; // the device, or the set's device side
    // One pose is less work than a submission to a CPU device, which would also delay contact queries.
    if (gone || (context_->device->facts().kind == DeviceKind::Cpu && baseTtool.size() == 1)) {
        findOnHost(set.host, tool, baseTtool, out);
        return;
    }
    if (!gpu_) {
        gpu_.emplace(*context_);
    }
    gpu_->setTool(tool);
    gpu_->find(set, tool, baseTtool, out);
}

void GapCycle::findOnHost(const HostFixtures& set, const Tool& tool, std::span<const Pose> baseTtool,
                          std::vector<SmallestGap>& out) {
    if (searched_ != &set || generation_ != set.generation) {
        cpu_.build(set);
        searched_ = &set;
        generation_ = set.generation;
    }
    out.clear();
    for (const Pose& pose : baseTtool) {
        out.push_back(cpu_.find(tool, pose));
    }
}

} // namespace fathom
