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
    , joints_(arm)
    , places_(arm)
    , normal_(arm.count())
    , release_(arm, options.release) {
    for (size_t k = 0; k < arm.count(); ++k) {
        now_.posture.q[k] = std::clamp(0.0, arm.joints[k].lower, arm.joints[k].upper);
        if (!arm.joints[k].mimic) {
            free_.push_back(k);
        }
    }
    arm.follow(now_.posture.q);
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
    arm_.follow(now_.posture.q);
    start_ = now_.posture.q;
    release_.reset(start_);
    arm_.place(now_.posture.q, base_, now_.frames, now_.posture.grasp);
}

void ArmKinematics::begin(const ProxyInput& input, ProxyRows&) noexcept {
    target_ = input.target;
    metricRadius_ = std::isfinite(input.metricRadius) ? std::clamp(input.metricRadius, 0.0, 10.0) : 0.0;
    start_ = now_.posture.q;
    escapeLeft_ = ProxyOptions::kEscapeSpeed * options_.period;
}

void ArmKinematics::report(ArmStep& out) const noexcept {
    out.q = now_.posture.q;
    out.grasp = now_.posture.grasp;
    out.residual = lengthOf(remaining(out.pose, target_), metricRadius_);
    out.contact = !out.active.empty() || out.blocked;
}

// The tighter of the position and the speed limit.
ArmKinematics::Range ArmKinematics::rangeOf(size_t unknown) const noexcept {
    const size_t joint = free_[unknown];
    const ArmJoint& j = arm_.joints[joint];
    const double reach = j.speed * options_.period;
    return {std::max(j.lower, start_[joint] - reach), std::min(j.upper, start_[joint] + reach)};
}

void ArmKinematics::addLimits(ProxyRows& rows) const noexcept {
    for (size_t u = 0; u < free_.size(); ++u) {
        const Range range = rangeOf(u);
        const double q = now_.posture.q[free_[u]], low = range.low - q, high = range.high - q;
        for (const double sign : {1.0, -1.0}) {
            JointVector normal{};
            normal[u] = sign;
            ContactRow row;
            row.kind = ContactRow::Kind::Joint;
            row.offset = std::min(0.0, sign > 0.0 ? low : -high);
            const ArmJoint& joint = arm_.joints[free_[u]];
            row.gap = std::min(0.0, sign > 0.0 ? joint.lower - q : q - joint.upper);
            row.key = ~uint64_t{0} - 2 * u - (sign > 0.0 ? 1 : 0);
            rows.add(row, normal);
        }
    }
}

JointVector ArmKinematics::normalOf(const ContactRow& row, const LeafState& leaves) const noexcept {
    if (row.kind != ContactRow::Kind::Equality) {
        return leafNormal(arm_.leaves[row.leaf], leafNow(row.leaf, leaves), row.normal);
    }
    JointVector normal{}; // constrains the tip
    const dvec3 tip = pose().position;
    for (size_t k = 0; k < arm_.count(); ++k) {
        normal[joints_.column[k]] +=
            joints_.gain[k] * (glm::dot(row.normal, arm_.motionOf(now_.frames, k, tip)) +
                               glm::dot(row.spin, arm_.rotationOf(now_.frames, k)));
    }
    return normal;
}

JointVector ArmKinematics::leafNormal(const ArmLeaf& leaf, const dvec3& centre,
                                      const dvec3& direction) const noexcept {
    JointVector normal{};
    for (size_t k = 0; k < leaf.joint; ++k) {
        normal[joints_.column[k]] +=
            joints_.gain[k] * glm::dot(direction, arm_.motionOf(now_.frames, k, centre));
    }
    for (size_t f = leaf.finger; f > 0; f = arm_.fingers[f - 1].carrier) {
        if (const auto& mimic = arm_.fingers[f - 1].mimic) {
            normal[joints_.column[mimic->joint]] +=
                mimic->multiplier * glm::dot(direction, arm_.motionOfFinger(now_.frames, f - 1, centre));
        }
    }
    return normal;
}

bool ArmKinematics::addRow(ContactRow row, const LeafState& leaves, ProxyRows& rows) const noexcept {
    const JointVector normal = normalOf(row, leaves);
    if (row.offset > proxy::kEscapeThreshold && row.kind != ContactRow::Kind::Equality) {
        // At most half of the motion that the joints have left in this tick.
        double possible = 0.0;
        for (size_t u = 0; u < free_.size(); ++u) {
            const Range range = rangeOf(u);
            const double q = now_.posture.q[free_[u]];
            possible += std::max(normal[u] * (range.low - q), normal[u] * (range.high - q));
        }
        row.offset = std::min(row.offset, 0.5 * possible);
    }
    return rows.add(row, normal);
}

bool ArmKinematics::beginLinearisation(ProxyRows& rows, ArmStep& out) noexcept {
    const Pose tip = pose();
    // The path to a far target is curved: request only what one solve can reach, or a stretched arm
    // oscillates.
    const Motion whole = remaining(tip, target_);
    const Motion left =
        std::min(1.0, kFarthestAim * options_.stepCap / divisorOf(whole, metricRadius_)) * whole;
    normal_ = ArmNormal(free_.size());
    for (size_t k = 0; k < arm_.count(); ++k) {
        normal_.addColumn(joints_.column[k], joints_.gain[k] * arm_.motionOf(now_.frames, k, tip.position),
                          joints_.gain[k] * metricRadius_ * arm_.rotationOf(now_.frames, k));
        if (!arm_.joints[k].mimic && arm_.joints[k].lower == arm_.joints[k].upper) {
            normal_.exclude(joints_.column[k]);
        }
    }
    const double smallest = normal_.smallestSingular(metricRadius_ == 0.0 ? 3 : 6);
    if (out.solves == 0) {
        out.smallestSingularValue = smallest;
        out.singular = smallest < options_.singularBelow;
        out.flipped = release_.begin(out.singular, now_.posture.q);
    }
    normal_.damp(dampingFor(smallest, options_.singularBelow, options_.damping, options_.singularDamping));
    normal_.solve(left.a, metricRadius_ * left.alpha, wanted_);
    nudged_ = smallest < options_.singularBelow &&
              release_.nudge(normal_, {left, whole, metricRadius_, now_.posture.q, now_.frames}, wanted_);
    rows.setMetric(normal_.metric());
    return true;
}

bool ArmKinematics::solve(Answer& answer, bool again, ProxyRows& rows, ArmStep& out) const noexcept {
    const std::span<const double> wanted(wanted_.data(), free_.size());
    JointVector dq{};
    const std::span<double> x(dq.data(), free_.size());
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
        out.atLimits = rows.atLimits();
        out.atPositionLimits = rows.atPositionLimits();
    }
    return true;
}

void ArmKinematics::tryPosture(const JointVector& q, double grasp, LeafState& leaves) noexcept {
    next_.posture = {q, grasp};
    arm_.place(q, base_, next_.frames, grasp);
    places_.place(next_.frames, leaves.origin, leaves.next);
}

void ArmKinematics::tryFraction(const Answer& answer, double fraction, LeafState& leaves) noexcept {
    JointVector q{};
    for (size_t u = 0; u < free_.size(); ++u) {
        const Range range = rangeOf(u);
        q[free_[u]] = std::clamp(now_.posture.q[free_[u]] + fraction * answer.dq[u], range.low, range.high);
    }
    arm_.follow(q);
    tryPosture(q, now_.posture.grasp, leaves);
}

// Cuts the solution to the step cap and tries it. The exact check enforces the trust region.
bool ArmKinematics::cutAndTry(Answer& answer, LeafContacts& contacts, const ProxyRows&) noexcept {
    answer.capFraction = 1.0;
    for (int k = 0; k < kCapTries; ++k) {
        tryFraction(answer, answer.capFraction, contacts.leaves);
        const double travel = contacts.leaves.travel();
        if (travel <= options_.stepCap) {
            return false;
        }
        answer.capFraction *= 0.999 * options_.stepCap / travel;
    }
    answer.capFraction = 0.0;
    tryFraction(answer, 0.0, contacts.leaves);
    return false;
}

StepOutcome ArmKinematics::outcomeOf(const Answer&, double fraction, const LeafState& leaves, ProxyRows&,
                                     const ArmStep& out) noexcept {
    if (fraction == 0.0) {
        return StepOutcome::None;
    }
    // Arcs and raised offsets must not move the tip away from a hand at rest.
    const double before = lengthOf(remaining(pose(), target_), metricRadius_);
    const double after = lengthOf(remaining(nextPose(), target_), metricRadius_);
    if (!out.escape && after >= before && before > proxy::kNegligible) {
        if (nudged_) {
            release_.rejected();
        }
        return StepOutcome::None;
    }
    escapeLeft_ *= 1.0 - fraction;
    return leaves.travel() > proxy::kNegligible ? StepOutcome::More : StepOutcome::Last;
}

// Joint arcs move the tip off a line by more than its linear rows predict, so the rows request the opposite
// error.
bool ArmKinematics::tightenEqualities(std::span<const Shape> shapes, double tried,
                                      ProxyRows& rows) const noexcept {
    bool changed = false;
    for (size_t i = 0; i < rows.size(); ++i) {
        ContactRow& row = rows[i];
        if (row.kind != ContactRow::Kind::Equality) {
            continue;
        }
        const size_t k = static_cast<size_t>(row.key & 0xff) / 2;
        std::array<Equality, kMaxEqualities> before, after;
        equalitiesOf(shapes[row.pair], pose(), before);
        if (k >= equalitiesOf(shapes[row.pair], nextPose(), after)) {
            continue;
        }
        const double sign = (row.key & 1) == 0 ? 1.0 : -1.0;
        const double limit = std::clamp(-before[k].error, -escapeLeft_, escapeLeft_);
        const double wrong = after[k].error - (before[k].error + tried * limit);
        if (std::abs(wrong) > 1e-13) {
            row.offset -= sign * wrong / std::max(tried, 1e-6);
            changed = true;
        }
    }
    return changed;
}

} // namespace fathom
