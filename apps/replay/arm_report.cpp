// SPDX-License-Identifier: Apache-2.0
#include "apps/replay/arm_report.h"

#include "engine/cycle/arm_text.h"

#include <algorithm>
#include <cmath>

namespace fathom {

namespace {

// Tolerance for joints and fingers exactly at a limit: a difference of two angles is rounded.
constexpr double kRounding = 1e-12;

// Distance of a mimic joint from where the joint that it follows puts it.
double apart(const ArmMimic& mimic, double q, const JointVector& joints) {
    return std::max(0.0, std::abs(q - mimic.offset - mimic.multiplier * joints[mimic.joint]) - kRounding);
}

// No comma, quote or line break in a column's name.
std::string column(std::string name) {
    std::replace_if(
        name.begin(), name.end(), [](char c) { return c == ',' || c == '"' || c < ' '; }, '_');
    return name;
}

} // namespace

ArmReport::ArmReport(const std::filesystem::path& file, const ArmSetup& setup, const std::string& realArm)
    : armSetup_(setup)
    , file_(file) {
    std::string header = "t_s";
    for (const ArmJoint& joint : setup.model.joints) {
        header += ',';
        header += column(joint.name);
        sums_.joints.push_back({joint.name, joint.lower, joint.upper, joint.speed, HUGE_VAL, -HUGE_VAL, 0.0});
    }
    header += ",grasp,residual_m,manipulability,at_limits,limit_violation,singular,grasp_held";
    if (!realArm.empty()) {
        sums_.driven = ReplaySummary::Arm::Driven{};
        sums_.driven->description = realArm;
        header += ",real_arm";
        for (const ArmJoint& joint : setup.model.joints) {
            header += ",measured_" + column(joint.name);
        }
    }
    file_.write(header + ",flipped\n");
    for (const std::string& link : setup.model.links) {
        sums_.links.push_back({link, 0, std::nullopt});
    }
    for (const ArmLeaf& leaf : setup.model.leaves) {
        ++sums_.links[leaf.link].leaves;
    }
    sums_.leaves = setup.model.leaves.size();
    sums_.description = describeArm(setup);
}

double ArmReport::violation(const TickRow& row) const {
    const ArmPosture& arm = row.record.arm.posture;
    double worst = 0.0;
    for (size_t k = 0; k < armSetup_.model.count(); ++k) {
        const ArmJoint& joint = armSetup_.model.joints[k];
        const double q = arm.q[k], way = std::abs(q - row.start.arm.q[k]);
        const double fast = way - joint.speed * armSetup_.proxy.period - kRounding;
        if (joint.mimic) { // narrows the joint that it follows
            worst = std::max(worst, apart(*joint.mimic, q, arm.q));
            continue;
        }
        worst = std::max({worst, joint.lower - q, q - joint.upper, fast});
    }
    for (const ArmFinger& finger : armSetup_.model.fingers) {
        if (finger.mimic) {
            continue;
        }
        const double at = finger.open + arm.grasp * (finger.closed - finger.open);
        worst = std::max({worst, finger.lower - at - kRounding, at - finger.upper - kRounding});
    }
    return worst;
}

void ArmReport::add(const TickRow& row) {
    const ArmRecord& arm = row.record.arm;
    const bool moved = row.record.state != StepState::Off; // held before the first set
    const double wrong = violation(row);
    row_.add(row.record.t);
    for (size_t k = 0; k < armSetup_.model.count(); ++k) {
        const double q = arm.posture.q[k];
        ReplaySummary::Arm::Joint& sum = sums_.joints[k];
        sum.least = std::min(sum.least, q);
        sum.most = std::max(sum.most, q);
        sum.fastest = std::max(sum.fastest, std::abs(q - row.start.arm.q[k]) / armSetup_.proxy.period);
        row_.add(q);
    }
    row_.add(arm.posture.grasp);
    row_.add(moved ? arm.residual : kNotKnown);
    row_.add(moved ? arm.smallestSingularValue : kNotKnown);
    row_.add(int64_t{arm.atLimits});
    row_.add(wrong);
    row_.add(int64_t{arm.singular});
    row_.add(int64_t{arm.graspHeld});
    if (sums_.driven) {
        addDriven(row);
    }
    row_.add(int64_t{arm.flipped});
    file_.write(row_.end());
    sums_.limitViolation = std::max(sums_.limitViolation, wrong);
    sums_.limitedTicks += arm.atLimits > 0 ? 1 : 0;
    sums_.singularTicks += arm.singular ? 1 : 0;
    sums_.flips += arm.flipped ? 1 : 0;
    sums_.graspHeldTicks += arm.graspHeld ? 1 : 0;
    if (moved) {
        residuals_.push_back(static_cast<float>(arm.residual));
    }
}

void ArmReport::addDriven(const TickRow& row) {
    const ArmStatus& status = row.armStatus;
    ReplaySummary::Arm::Driven& driven = *sums_.driven;
    row_.add(std::string(armStateName(status.state)));
    for (size_t k = 0; k < armSetup_.model.count(); ++k) {
        row_.add(status.known ? status.posture.q[k] : kNotKnown);
    }
    ++ticks_[static_cast<size_t>(status.state)];
    driven.lastState = armStateName(status.state);
    driven.damaged = std::max(driven.damaged, status.damaged);
    driven.reopened = status.reopened;
    if (status.known) {
        driven.oldest = std::max(driven.oldest, status.age);
    }
    if (status.state == ArmState::Follows) {
        const double lag = glm::distance(armSetup_.tipAt(status.posture).position, row.record.tool.position);
        tipLags_.push_back(static_cast<float>(lag));
    }
}

ReplaySummary::Arm ArmReport::summary(const std::vector<double>& links) {
    ReplaySummary::Arm out = sums_;
    for (size_t i = 0; i < out.links.size() && i < links.size(); ++i) {
        out.links[i].penetration = links[i];
    }
    out.residual = percentilesOf(std::move(residuals_));
    for (size_t i = 0; out.driven && i < kArmStates; ++i) {
        out.driven->ticks.emplace_back(armStateName(static_cast<ArmState>(i)), ticks_[i]);
    }
    if (out.driven) {
        out.driven->tipLag = percentilesOf(std::move(tipLags_));
    }
    return out;
}

} // namespace fathom
