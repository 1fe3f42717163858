// SPDX-License-Identifier: Apache-2.0
// The conditions on the next joint increments at the present posture.
#include "engine/haptics/arm_proxy.h"

#include "engine/haptics/proxy_limits.h"

#include <algorithm>
#include <cmath>

namespace fathom {

double ArmProxy::clampedJoint(size_t k, double q) const noexcept {
    const double reach = arm_.joints[k].speed * options_.period;
    return std::clamp(q, std::max(arm_.joints[k].lower, start_[k] - reach),
                      std::min(arm_.joints[k].upper, start_[k] + reach));
}

void ArmProxy::addLeafRow(const ContactRow& row, double offset) noexcept {
    const ArmLeaf& leaf = arm_.leaves[row.leaf];
    const dvec3 centre = arm_.centre(frames_, row.leaf);
    JointVector normal{};
    for (size_t k = 0; k < leaf.joint; ++k) {
        normal[k] = glm::dot(row.normal, arm_.motionOf(frames_, k, centre));
    }
    // No more than half of what the joints can do in what is left of the turn.
    double possible = 0.0;
    for (size_t k = 0; k < leaf.joint && offset > proxy::kAsks; ++k) {
        const double low = clampedJoint(k, -1e9) - q_[k], high = clampedJoint(k, 1e9) - q_[k];
        possible += std::max(normal[k] * low, normal[k] * high);
    }
    offset = offset > proxy::kAsks ? std::min(offset, 0.5 * possible) : offset;
    const size_t at = solver_.rows();
    if (solver_.addRow(std::span(normal.data(), n_), offset)) {
        solver_.setKey(at, row.key);
        rowPair_[at] = row.pair;
    }
}

// Limits of place and of speed, whichever is nearer, about the present joints.
void ArmProxy::addJointRows() noexcept {
    for (size_t k = 0; k < n_; ++k) {
        const double reach = arm_.joints[k].speed * options_.period;
        const double low = std::max(arm_.joints[k].lower, start_[k] - reach) - q_[k];
        const double high = std::min(arm_.joints[k].upper, start_[k] + reach) - q_[k];
        for (const double sign : {1.0, -1.0}) {
            JointVector normal{};
            normal[k] = sign;
            const size_t at = solver_.rows();
            solver_.addRow(std::span(normal.data(), n_), std::min(0.0, sign > 0.0 ? low : -high));
            solver_.setKey(at, ~uint64_t{0} - 2 * k - (sign > 0.0 ? 1 : 0));
            rowPair_[at] = armrow::kJoint;
        }
    }
}

void ArmProxy::collectRows(const ContactSet* contacts, ArmTurn& out) noexcept {
    solver_.clearRows();
    addJointRows();
    if (contacts == nullptr) {
        return;
    }
    const double checkLimit = options_.stepCap * (1.0 + 1e-6) + proxy::kSkin;
    narrow_.gather(*contacts, leaves_, frames_[0].position - contacts->origin, 2.0 * options_.stepCap,
                   checkLimit, out.solves == 0);
    trust_.set(*contacts, narrow_.moved());
    out.escape = out.escape || narrow_.smallestGap() < -proxy::kNothing;
    for (const ContactRow& row : narrow_.rows()) {
        const double asked = row.gap < 0.0 ? std::min(-row.gap, escapeLeft_) : -row.gap;
        addLeafRow(row, asked + proxy::kSkin);
    }
}

// Asks more of the pairs that a motion took in too deep. False when nothing could be asked for.
bool ArmProxy::strengthen(size_t violating, double share) noexcept {
    const size_t before = solver_.rows();
    bool changed = false;
    for (size_t v = 0; v < std::min(violating, violations_.size()); ++v) {
        const NarrowPhase::Violation& violation = violations_[v];
        size_t at = 0;
        while (at < before && rowPair_[at] != violation.row.pair) {
            ++at;
        }
        if (at < before) {
            solver_.setOffset(at,
                              solver_.offset(at) + violation.depth / std::max(share, 1e-6) + proxy::kSkin);
        } else {
            addLeafRow(violation.row, -std::max(0.0, violation.row.gap) + proxy::kSkin);
        }
        changed = true;
    }
    return changed;
}

void ArmProxy::countActive(ArmTurn& out) const noexcept {
    out.contacts = out.atLimits = 0;
    const auto multipliers = solver_.multipliers();
    for (size_t i = 0; i < multipliers.size(); ++i) {
        if (multipliers[i] > 0.0) {
            ++(rowPair_[i] == armrow::kJoint ? out.atLimits : out.contacts);
        }
    }
}

} // namespace fathom
