// SPDX-License-Identifier: Apache-2.0
#include "apps/replay/tool_audit.h"

#include <algorithm>

namespace fathom {

ToolAudit::ToolAudit(const Tool& tool, const ArmSetup* arm)
    : arm_(arm)
    , audit_(arm != nullptr ? arm->toolAt({arm->start, 0.0}) : tool) {}

void ToolAudit::place(const ArmPosture& posture, std::vector<dvec3>& centres) const {
    const ArmFrames frames = arm_->framesAt(posture);
    centres.resize(arm_->model.leaves.size());
    for (size_t i = 0; i < centres.size(); ++i) {
        centres[i] = arm_->model.centre(frames, i);
    }
}

void ToolAudit::tick(const HostFixtures& set, const RegionGrid& grid, const ToolPlace& start,
                     const ToolPlace& end, std::span<const uint32_t> behind) {
    if (arm_ == nullptr) {
        audit_.tick(set, grid, start.pose, end.pose, behind);
        return;
    }
    place(start.arm, start_);
    place(end.arm, end_);
    audit_.tick(set, grid, start_, end_, behind);
}

std::vector<double> ToolAudit::linkPenetration() const {
    std::vector<double> deepest(arm_ != nullptr ? arm_->model.links.size() : 0, 0.0);
    for (size_t i = 0; arm_ != nullptr && i < arm_->model.leaves.size(); ++i) {
        double& link = deepest[arm_->model.leaves[i].link];
        link = std::max(link, audit_.leafPenetration(i));
    }
    return deepest;
}

} // namespace fathom
