// SPDX-License-Identifier: Apache-2.0
// Audits the penetration of a run's tool: a free tool from its poses, an arm from the leaves of all links.
#pragma once

#include "engine/cycle/arm_setup.h"
#include "engine/cycle/step_record.h"
#include "engine/reference/penetration_audit.h"

#include <vector>

namespace fathom {

// Not for the haptic thread. Computes the positions of an arm's leaves from its joints.
class ToolAudit {
public:
    // arm: null = the tool moves freely. Both must outlive this.
    ToolAudit(const Tool& tool, const ArmSetup* arm);

    // Like PenetrationAudit::tick().
    void tick(const HostFixtures& set, const RegionGrid& grid, const ToolPlace& start, const ToolPlace& end,
              std::span<const uint32_t> behind);

    void retake() { audit_.retake(); } // like PenetrationAudit::retake()
    const PenetrationAudit& figures() const { return audit_; }
    // [m] largest depth of each link's leaves beyond the allowance, in the order of ArmModel::links; empty
    // without an arm.
    std::vector<double> linkPenetration() const;

private:
    void place(const ArmPosture& posture, std::vector<dvec3>& centres) const;

    const ArmSetup* arm_;
    PenetrationAudit audit_;
    std::vector<dvec3> start_, end_; // [m] base frame: the leaves before and after a step
};

} // namespace fathom
