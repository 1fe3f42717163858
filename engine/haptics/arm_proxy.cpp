// SPDX-License-Identifier: Apache-2.0
#include "engine/haptics/arm_proxy.h"

#include "engine/haptics/arm_damping.h"
#include "engine/haptics/proxy_limits.h"

#include <algorithm>
#include <cmath>

namespace fathom {

namespace {

constexpr double kFarthestAim = 2.0; // times the step cap

double lengthOf(const Motion& m, double k) {
    return std::sqrt(std::max(1e-300, glm::dot(m.a, m.a) + k * k * glm::dot(m.alpha, m.alpha)));
}

} // namespace

Tool armTool(const ArmModel& arm, const ArmFrames& frames) {
    SphereTree tree; // one level of leaves in the arm's own order under one root
    tree.levels = 2;
    tree.degree = static_cast<uint32_t>(arm.leaves.size());
    tree.nodes.resize(arm.leaves.size() + 1);
    Sphere& root = tree.nodes[0];
    root = {arm.centre(frames, 0), 0.0};
    for (size_t i = 0; i < arm.leaves.size(); ++i) {
        tree.nodes[i + 1] = {arm.centre(frames, i), arm.leaves[i].sphere.radius};
        root.radius = std::max(root.radius, glm::distance(root.centre, tree.nodes[i + 1].centre) +
                                                tree.nodes[i + 1].radius);
    }
    root.radius *= 1.0 + 1e-9;
    return Tool(std::move(tree));
}

ArmProxy::ArmProxy(const ArmModel& arm, const Pose& baseTarm, const ArmProxyOptions& options,
                   const JointVector& start)
    : arm_(arm)
    , base_(baseTarm)
    , options_(options)
    , n_(arm.count())
    , narrow_(
          [&] {
              ArmFrames frames;
              arm.place(JointVector{}, baseTarm, frames);
              return armTool(arm, frames);
          }(),
          kMostLeafRows)
    , trust_(arm.leaves.size())
    , solver_(static_cast<int>(arm.count()), kMostRows)
    , leaves_(arm.leaves.size())
    , nextLeaves_(arm.leaves.size())
    , exempt_(arm.leaves.size(), dvec3(0.0))
    , violations_(kMostViolations)
    , rowPair_(kMostRows, armrow::kJoint) {
    for (size_t k = 0; k < n_; ++k) {
        q_[k] =
            std::clamp(std::isfinite(start[k]) ? start[k] : 0.0, arm.joints[k].lower, arm.joints[k].upper);
    }
    start_ = q_;
    arm_.place(q_, base_, frames_);
}

void ArmProxy::placeLeaves(const ArmFrames& frames, const dvec3& origin, LeafCentres& out) const noexcept {
    for (size_t i = 0; i < arm_.leaves.size(); ++i) {
        out.set(i, arm_.centre(frames, i) - origin);
    }
}

bool ArmProxy::covers(const ContactSet& contacts) noexcept {
    if (contacts.leafAtQuery.size() != arm_.leaves.size()) {
        return false;
    }
    placeLeaves(frames_, contacts.origin, leaves_);
    return TrustRegion::covers(contacts, leaves_);
}

ArmProxy::Goal ArmProxy::aim(const Pose& target, double k, ArmTurn& out) noexcept {
    const Pose now = tip();
    // A target far away bends the way there: only what a solve can go is asked for, or a stretched arm
    // dances.
    Motion left = remaining(now, target);
    left = std::min(1.0, kFarthestAim * options_.stepCap / lengthOf(left, k)) * left;
    ArmNormal normal(n_);
    for (size_t j = 0; j < n_; ++j) {
        const dvec3 turning = arm_.joints[j].slides ? dvec3(0.0) : arm_.axisOf(frames_, j);
        normal.setColumn(j, arm_.motionOf(frames_, j, now.position), k * turning);
    }
    const double smallest = normal.smallestSingular();
    if (out.solves == 0) {
        out.manipulability = smallest;
        out.singular = smallest < options_.singularBelow;
    }
    Goal goal;
    goal.lambda = dampingFor(smallest, options_.singularBelow, options_.damping, options_.singularDamping);
    normal.damp(goal.lambda);
    normal.solve(left.a, k * left.alpha, goal.wanted);
    solver_.setMetric(normal.metric());
    return goal;
}

void ArmProxy::tryStep(const JointVector& dq, double share, const dvec3& origin) noexcept {
    for (size_t k = 0; k < n_; ++k) {
        next_[k] = clampedJoint(k, q_[k] + share * dq[k]);
    }
    arm_.place(next_, base_, nextFrames_);
    placeLeaves(nextFrames_, origin, nextLeaves_);
}

double ArmProxy::shareToCap(const JointVector& dq, const dvec3& origin) noexcept {
    double share = 1.0;
    for (int k = 0; k < 12; ++k) {
        tryStep(dq, share, origin);
        const double travel = longestTravel(leaves_, nextLeaves_);
        if (travel <= options_.stepCap) {
            return share;
        }
        share *= 0.999 * options_.stepCap / travel;
    }
    tryStep(dq, 0.0, origin);
    return 0.0;
}

bool ArmProxy::allowed(const ContactSet* contacts, size_t& violating) noexcept {
    violating = 0;
    if (contacts == nullptr) {
        return true;
    }
    violating = narrow_.check(*contacts, nextLeaves_, exempt_, violations_);
    return violating == 0 && trust_.contains(*contacts, nextLeaves_);
}

// Solves, cuts to the caps, checks exactly; strengthens and solves again; at last shortens. Returns the
// share.
double ArmProxy::fit(JointVector& dq, const Goal& goal, const ContactSet* contacts, ArmTurn& out) noexcept {
    const dvec3 origin = contacts != nullptr ? contacts->origin : dvec3(0.0);
    double share = 1.0;
    size_t violating = 0;
    for (int round = 0; round < proxy::kRounds; ++round) {
        share = shareToCap(dq, origin);
        if (allowed(contacts, violating)) {
            return share;
        }
        JointVector other{};
        if (violating == 0 || !strengthen(violating, share) ||
            solver_.solve(std::span(goal.wanted.data(), n_), std::span(other.data(), n_)) !=
                SolveStatus::Optimal) {
            break;
        }
        dq = other;
    }
    out.stalled = out.stalled || violating == 0;
    double good = 0.0, bad = share;
    for (int k = 0; k < proxy::kBisections; ++k) {
        const double middle = 0.5 * (good + bad);
        tryStep(dq, middle, origin);
        (allowed(contacts, violating) ? good : bad) = middle;
    }
    tryStep(dq, good, origin);
    return good;
}

// Where rows that ask for motion contradict each other, they ask for no worse than now.
bool ArmProxy::solveRows(const Goal& goal, JointVector& dq) noexcept {
    const std::span<const double> wanted(goal.wanted.data(), n_);
    if (solver_.solve(wanted, std::span(dq.data(), n_)) == SolveStatus::Optimal) {
        return true;
    }
    for (size_t i = 0; i < solver_.rows(); ++i) {
        solver_.setOffset(i, std::min(0.0, solver_.offset(i)));
    }
    return solver_.solve(wanted, std::span(dq.data(), n_)) == SolveStatus::Optimal;
}

// One linearisation. True when another one may bring the tip nearer.
bool ArmProxy::step(const Pose& target, double k, const ContactSet* contacts, ArmTurn& out) noexcept {
    placeLeaves(frames_, contacts != nullptr ? contacts->origin : dvec3(0.0), leaves_);
    collectRows(contacts, out);
    const Goal goal = aim(target, k, out);
    ++out.solves;
    JointVector dq{};
    if (!solveRows(goal, dq)) {
        out.trapped = out.solves == 1;
        return false;
    }
    countActive(out);
    const double share = fit(dq, goal, contacts, out);
    if (share == 0.0) {
        return false;
    }
    // What arcs and raised offsets add must not carry the tip away from a hand that is still.
    const double before = lengthOf(remaining(tip(), target), k);
    const double after = lengthOf(remaining(arm_.tip(nextFrames_), target), k);
    if (!out.escape && after >= before && before > proxy::kNothing) {
        return false;
    }
    escapeLeft_ *= 1.0 - share;
    const double travel = longestTravel(leaves_, nextLeaves_);
    q_ = next_;
    frames_ = nextFrames_;
    return travel > proxy::kNothing;
}

ArmTurn ArmProxy::turn(const Pose& target, double metricRadius, const ContactSet* contacts) noexcept {
    ArmTurn out;
    start_ = q_;
    escapeLeft_ = options_.escapePerTurn;
    const double k = std::isfinite(metricRadius) ? std::clamp(metricRadius, 0.0, 10.0) : 0.0;
    const bool usable = contacts == nullptr || contacts->leafAtQuery.size() == arm_.leaves.size();
    if (usable && isFinite(target)) {
        while (out.solves < options_.solves && step(target, k, contacts, out)) {
        }
    }
    out.q = q_;
    out.tip = tip();
    out.residual = lengthOf(remaining(out.tip, target), k);
    if (contacts != nullptr && usable) {
        placeLeaves(frames_, contacts->origin, leaves_);
        out.minGap = narrow_.smallestGapAt(*contacts, leaves_);
    }
    return out;
}

} // namespace fathom
