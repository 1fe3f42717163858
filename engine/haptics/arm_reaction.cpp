// SPDX-License-Identifier: Apache-2.0
// What the regions allow the tip of an arm, without the caps and the joint speeds: the base of the reaction.
#include "engine/haptics/arm_kinematics.h"

namespace fathom {

Motion ArmKinematics::motionOf(const JointVector& dq) const noexcept {
    const dvec3 tip = pose().position;
    Motion motion;
    for (size_t k = 0; k < arm_.count(); ++k) {
        const double moved = joints_.gain[k] * dq[joints_.column[k]];
        motion.a += moved * arm_.motionOf(now_.frames, k, tip);
        motion.alpha += moved * arm_.rotationOf(now_.frames, k);
    }
    return motion;
}

// The solution for the whole remaining motion, without joint speeds. Overwrites the rows' offsets.
JointVector ArmKinematics::uncutAnswer(const Answer& answer, ProxyRows& rows) const noexcept {
    const Motion left = remaining(pose(), target_);
    JointVector wanted{}, dq{};
    normal_.solve(left.a, metricRadius_ * left.alpha, wanted);
    const std::span<const double> target(wanted.data(), free_.size());
    const std::span<double> x(dq.data(), free_.size());
    rows.ignoreSpeeds();
    rows.load(target);
    return rows.solve(target, x) ? dq : answer.dq;
}

void ArmKinematics::recordAllowed(const Answer& answer, bool blocked, const LeafContacts& contacts,
                                  ProxyRows& rows, ArmStep& out) const noexcept {
    out.cut = true;
    out.allowed = target_;
    if (rows.active().empty() && out.atPositionLimits == 0 && !blocked) {
        return;
    }
    out.blocked = blocked && rows.active().empty();
    Motion whole;
    if (!blocked) {
        whole = motionOf(uncutAnswer(answer, rows));
    }
    // Only what some joint could reduce is a reaction; the rest lies outside of the workspace.
    const Motion residual = remaining(pose(), target_) - whole;
    JointVector visible{};
    normal_.solve(residual.a, metricRadius_ * residual.alpha, visible);
    const Motion reaction = motionOf(visible);
    out.allowed = moved(target_, -1.0 * reaction);
    const double travel = glm::length(whole.a) + glm::length(whole.alpha) * metricRadius_;
    out.rowsExpired = travel > contacts.tangentTravel(rows.active());
}

} // namespace fathom
