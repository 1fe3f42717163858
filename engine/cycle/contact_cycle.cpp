// SPDX-License-Identifier: Apache-2.0
#include "engine/cycle/contact_cycle.h"

#include "engine/types/log.h"

#include <algorithm>

namespace fathom {

namespace {

constexpr double kReachWithoutRegions = 1000.0; // [m] the tool may go anywhere

} // namespace

ContactCycle::ContactCycle(const Tool& tool, double reach, const ArmSetup* arm)
    : tool_(tool)
    , arm_(arm)
    , reach_(reach) {}

ContactCycle::ContactCycle(const cloud::QueryContext& context, const Tool& tool, double reach,
                           const ArmSetup* arm, const QueryCapacity& capacity)
    : ContactCycle(tool, reach, arm) {
    cpu_ = CullCpu(capacity);
    gpuLoop_ = QueryLoop(capacity);
    use(context);
}

void ContactCycle::use(const cloud::QueryContext& context) {
    where_ = context.plan.query;
    layout_ = context.layout;
    if (where_ != Plan::Query::Gpu) {
        return;
    }
    gpu_.emplace(context);
    if (!gpu_->passesProbe()) {
        log::warn("contact query: {} misses contacts in a test of its arithmetic: the CPU answers",
                  context.device->facts().name);
        gpu_.reset();
    } else if (arm_ == nullptr) {
        gpu_->setTool(tool_);
    }
}

void ContactCycle::query(const cloud::FixtureSet& set, const QueryPlace& at, ContactSet& out) {
    if (arm_ != nullptr) { // the arm's leaves are already in the base frame
        ask(arm_->toolAt(at.place.arm), set, Pose{}, reach_ + at.extraReach, out);
    } else {
        ask(tool_, set, at.place.pose, reach_ + at.extraReach, out);
    }
    out.askedAt = at.askedAt;
    out.query = ++queries_; // one numbering for CPU and GPU answers
}

void ContactCycle::ask(const Tool& tool, const cloud::FixtureSet& set, const Pose& baseTtool, double reach,
                       ContactSet& out) {
    const bool onHost = !gpu_ || !set.device.nodes; // the device or the set's device side is gone
    switch (where_ == Plan::Query::Gpu && onHost ? Plan::Query::Cpu : where_) {
    case Plan::Query::None:
        out.clear();
        describeQuery(tool, baseTtool, kReachWithoutRegions, set.host, out);
        out.pairBegin.assign(tool.leafCount() + 1, 0);
        out.pairBandEnd.assign(tool.leafCount() * ContactSet::kGapBands, 0);
        return;
    case Plan::Query::Cpu:
        cpu_.query(tool, baseTtool, reach, set.host, set.grid.get(), out);
        behind_.update(tool, set.host, set.largestRadius, out);
        return;
    case Plan::Query::Gpu:
        askDevice(tool, set, baseTtool, reach, out);
        const PatchBits forbidden = set.forbidden(layout_);
        behind_.update(tool, set.host, set.largestRadius, out, &forbidden);
        return;
    }
}

void ContactCycle::askDevice(const Tool& tool, const cloud::FixtureSet& set, const Pose& baseTtool,
                             double reach, ContactSet& out) {
    if (arm_ != nullptr) {
        gpu_->setTool(tool); // its leaves move with the joints
    }
    const auto onDevice = [&](double within, const QueryCapacity& most, ContactSet& filled) {
        if (!gpu_->list(set, baseTtool, within, near_)) {
            fillContactSet(tool, baseTtool, within, set.host, {}, filled); // no sphere
            return false;
        }
        describeQuery(tool, baseTtool, within, set.host, filled);
        return decidePairs(tool, near_, most.pairs, scratch_, filled);
    };
    gpuLoop_.run(reach, onDevice, out);
}

QueryStatistics ContactCycle::statistics() const {
    const QueryStatistics onCpu = cpu_.statistics(), onGpu = gpuLoop_.statistics();
    return {onCpu.queries + onGpu.queries, onCpu.overflows + onGpu.overflows,
            std::max(onCpu.spheresMax, onGpu.spheresMax), std::max(onCpu.pairsMax, onGpu.pairsMax)};
}

} // namespace fathom
