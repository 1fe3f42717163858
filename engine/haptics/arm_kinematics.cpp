// SPDX-License-Identifier: Apache-2.0
#include "engine/haptics/arm_kinematics.h"

#include <cmath>

namespace fathom {

namespace {

constexpr double kFarthestAim = 2.0; // step caps
constexpr int kCapTries = 12;

} // namespace

ArmKinematics::ArmKinematics(const ArmModel& arm, const Pose& baseTarm, const ArmProxyOptions& options)
    : arm_(arm)
    , base_(baseTarm)
    , options_(options)
    , places_(arm)
    , normal_(arm.count()) {
    for (size_t k = 0; k < arm.count(); ++k) {
        now_.posture.q[k] = std::clamp(0.0, arm.joints[k].lower, arm.joints[k].upper);
    }
}

void ArmKinematics::setPosture(const ArmPosture& posture) noexcept {
    for (size_t k = 0; k < arm_.count(); ++k) {
        double& q = now_.posture.q[k];
        q = std::clamp(std::isfinite(posture.q[k]) ? posture.q[k] : q, arm_.joints[k].lower,
                       arm_.joints[k].upper);
    }
    if (std::isfinite(posture.grasp)) {
        now_.posture.grasp = std::clamp(posture.grasp, 0.0, 1.0);
    }
    start_ = now_.posture.q;
    arm_.place(now_.posture.q, base_, now_.frames, now_.posture.grasp);
}

void ArmKinematics::begin(const ProxyInput& input, ProxyRows&) noexcept {
    target_ = input.target;
    metricRadius_ = std::isfinite(input.metricRadius) ? std::clamp(input.metricRadius, 0.0, 10.0) : 0.0;
    start_ = now_.posture.q;
    escapeLeft_ = options_.escapePerTick;
}

void ArmKinematics::report(ArmStep& out) const noexcept {
    out.q = now_.posture.q;
    out.grasp = now_.posture.grasp;
    out.residual = lengthOf(remaining(out.pose, target_), metricRadius_);
    out.contact = out.contacts > 0 || out.atLimits > 0;
}

// The tighter of the position and the speed limit.
ArmKinematics::Range ArmKinematics::rangeOf(size_t joint) const noexcept {
    const ArmJoint& j = arm_.joints[joint];
    const double reach = j.speed * options_.period;
    return {std::max(j.lower, start_[joint] - reach), std::min(j.upper, start_[joint] + reach)};
}

void ArmKinematics::addLimits(ProxyRows& rows) const noexcept {
    for (size_t k = 0; k < arm_.count(); ++k) {
        const Range range = rangeOf(k);
        const double low = range.low - now_.posture.q[k], high = range.high - now_.posture.q[k];
        for (const double sign : {1.0, -1.0}) {
            JointVector normal{};
            normal[k] = sign;
            ContactRow row;
            row.kind = ContactRow::Kind::Joint;
            row.offset = std::min(0.0, sign > 0.0 ? low : -high);
            const ArmJoint& joint = arm_.joints[k];
            const double q = now_.posture.q[k];
            row.gap = std::min(0.0, sign > 0.0 ? joint.lower - q : q - joint.upper);
            row.key = ~uint64_t{0} - 2 * k - (sign > 0.0 ? 1 : 0);
            rows.add(row, normal);
        }
    }
}

JointVector ArmKinematics::normalOf(const ContactRow& row, const LeafState& leaves) const noexcept {
    JointVector normal{};
    if (row.kind == ContactRow::Kind::Equality) { // constrains the tip
        const dvec3 tip = pose().position;
        for (size_t k = 0; k < arm_.count(); ++k) {
            const dvec3 rotation = arm_.joints[k].slides ? dvec3(0.0) : arm_.axisOf(now_.frames, k);
            normal[k] =
                glm::dot(row.normal, arm_.motionOf(now_.frames, k, tip)) + glm::dot(row.spin, rotation);
        }
        return normal;
    }
    const dvec3 centre = leafNow(row.leaf, leaves);
    for (size_t k = 0; k < arm_.leaves[row.leaf].joint; ++k) {
        normal[k] = glm::dot(row.normal, arm_.motionOf(now_.frames, k, centre));
    }
    return normal;
}

bool ArmKinematics::addRow(ContactRow row, const LeafState& leaves, ProxyRows& rows) const noexcept {
    const JointVector normal = normalOf(row, leaves);
    if (row.offset > proxy::kEscapeThreshold && row.kind != ContactRow::Kind::Equality) {
        // At most half of the motion that the joints have left in this tick.
        double possible = 0.0;
        for (size_t k = 0; k < arm_.leaves[row.leaf].joint; ++k) {
            const Range range = rangeOf(k);
            const double low = range.low - now_.posture.q[k], high = range.high - now_.posture.q[k];
            possible += std::max(normal[k] * low, normal[k] * high);
        }
        row.offset = std::min(row.offset, 0.5 * possible);
    }
    return rows.add(row, normal);
}

bool ArmKinematics::aim(const LeafState&, ProxyRows& rows, ArmStep& out) noexcept {
    const Pose tip = pose();
    // The path to a far target is curved: request only what one solve can reach, or a stretched arm
    // oscillates.
    Motion left = remaining(tip, target_);
    left = std::min(1.0, kFarthestAim * options_.stepCap / lengthOf(left, metricRadius_)) * left;
    normal_ = ArmNormal(arm_.count());
    for (size_t j = 0; j < arm_.count(); ++j) {
        const dvec3 rotation = arm_.joints[j].slides ? dvec3(0.0) : arm_.axisOf(now_.frames, j);
        normal_.setColumn(j, arm_.motionOf(now_.frames, j, tip.position), metricRadius_ * rotation);
        if (arm_.joints[j].lower == arm_.joints[j].upper) {
            normal_.leaveOut(j);
        }
    }
    const double smallest = normal_.smallestSingular(metricRadius_ == 0.0 ? 3 : 6);
    if (out.solves == 0) {
        out.manipulability = smallest;
        out.singular = smallest < options_.singularBelow;
    }
    normal_.damp(dampingFor(smallest, options_.singularBelow, options_.damping, options_.singularDamping));
    normal_.solve(left.a, metricRadius_ * left.alpha, wanted_);
    rows.setMetric(normal_.metric());
    return true;
}

bool ArmKinematics::solve(Answer& answer, bool again, ProxyRows& rows, ArmStep& out) const noexcept {
    const std::span<const double> wanted(wanted_.data(), arm_.count());
    JointVector dq{};
    const std::span<double> x(dq.data(), arm_.count());
    rows.load(wanted);
    bool optimal = rows.solve(wanted, x);
    if (!optimal && !again) {
        ++out.infeasible;
        rows.relaxAll();
        optimal = rows.solve(wanted, x);
    }
    if (!optimal) {
        return false;
    }
    answer.dq = dq;
    if (!again) {
        rows.recordActive();
        out.contacts = static_cast<uint32_t>(rows.active().size());
        out.atLimits = rows.atLimits();
        out.atEnds = rows.atEnds();
    }
    return true;
}

void ArmKinematics::tryPosture(const JointVector& q, double grasp, LeafState& leaves) noexcept {
    next_.posture = {q, grasp};
    arm_.place(q, base_, next_.frames, grasp);
    places_.place(next_.frames, leaves.origin, leaves.next);
}

void ArmKinematics::tryPart(const Answer& answer, double part, LeafState& leaves) noexcept {
    JointVector q{};
    for (size_t k = 0; k < arm_.count(); ++k) {
        const Range range = rangeOf(k);
        q[k] = std::clamp(now_.posture.q[k] + part * answer.dq[k], range.low, range.high);
    }
    tryPosture(q, now_.posture.grasp, leaves);
}

// Cuts the solution to the step cap and tries it. The exact check enforces the trust region.
bool ArmKinematics::fit(Answer& answer, LeafContacts& contacts, const ProxyRows&) noexcept {
    answer.share = 1.0;
    for (int k = 0; k < kCapTries; ++k) {
        tryPart(answer, answer.share, contacts.leaves);
        const double travel = contacts.leaves.travel();
        if (travel <= options_.stepCap) {
            return false;
        }
        answer.share *= 0.999 * options_.stepCap / travel;
    }
    answer.share = 0.0;
    tryPart(answer, 0.0, contacts.leaves);
    return false;
}

Motion ArmKinematics::motionOf(const JointVector& dq) const noexcept {
    const dvec3 tip = pose().position;
    Motion motion;
    for (size_t k = 0; k < arm_.count(); ++k) {
        motion.a += dq[k] * arm_.motionOf(now_.frames, k, tip);
        motion.alpha += dq[k] * (arm_.joints[k].slides ? dvec3(0.0) : arm_.axisOf(now_.frames, k));
    }
    return motion;
}

// The solution for the whole remaining motion, without joint speeds. Overwrites the rows' offsets.
JointVector ArmKinematics::uncutAnswer(const Answer& answer, ProxyRows& rows) const noexcept {
    const Motion left = remaining(pose(), target_);
    JointVector wanted{}, dq{};
    normal_.solve(left.a, metricRadius_ * left.alpha, wanted);
    const std::span<const double> target(wanted.data(), arm_.count());
    const std::span<double> x(dq.data(), arm_.count());
    rows.ignoreSpeeds();
    rows.load(target);
    return rows.solve(target, x) ? dq : answer.dq;
}

void ArmKinematics::recordAllowed(const Answer& answer, bool blocked, const LeafContacts& contacts,
                                  ProxyRows& rows, ArmStep& out) const noexcept {
    out.cut = true;
    out.allowed = target_;
    if (out.contacts == 0 && out.atEnds == 0 && !blocked) {
        return;
    }
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
    out.stale = travel > contacts.tangentTravel(rows.active());
}

StepOutcome ArmKinematics::judge(const Answer&, double part, const LeafState& leaves, ProxyRows&,
                                 const ArmStep& out) noexcept {
    if (part == 0.0) {
        return StepOutcome::None;
    }
    // Arcs and raised offsets must not move the tip away from a hand at rest.
    const double before = lengthOf(remaining(pose(), target_), metricRadius_);
    const double after = lengthOf(remaining(nextPose(), target_), metricRadius_);
    if (!out.escape && after >= before && before > proxy::kNothing) {
        return StepOutcome::None;
    }
    escapeLeft_ *= 1.0 - part;
    return leaves.travel() > proxy::kNothing ? StepOutcome::More : StepOutcome::Last;
}

// Joint arcs move the tip off a line by more than its linear rows predict, so the rows request the opposite
// error.
bool ArmKinematics::tightenEqualities(std::span<const Shape> shapes, double share,
                                      ProxyRows& rows) const noexcept {
    bool changed = false;
    for (size_t i = 0; i < rows.size(); ++i) {
        ContactRow& row = rows[i];
        if (row.kind != ContactRow::Kind::Equality) {
            continue;
        }
        const size_t k = static_cast<size_t>(row.key & 0xff) / 2;
        std::array<Equality, kMostEqualities> before, after;
        equalitiesOf(shapes[row.pair], pose(), before);
        if (k >= equalitiesOf(shapes[row.pair], nextPose(), after)) {
            continue;
        }
        const double sign = (row.key & 1) == 0 ? 1.0 : -1.0;
        const double limit = std::clamp(-before[k].error, -escapeLeft_, escapeLeft_);
        const double wrong = after[k].error - (before[k].error + share * limit);
        if (std::abs(wrong) > 1e-13) {
            row.offset -= sign * wrong / std::max(share, 1e-6);
            changed = true;
        }
    }
    return changed;
}

} // namespace fathom
