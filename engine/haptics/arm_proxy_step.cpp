// SPDX-License-Identifier: Apache-2.0
// One linearisation of an arm: solve, cut to the step cap, check every pair and shape exactly, and only then
// move.
#include "engine/haptics/arm_proxy.h"

#include "engine/haptics/proxy_limits.h"
#include "engine/haptics/row_rules.h"

#include <algorithm>
#include <cmath>

namespace fathom {

void ArmProxy::tryPosture(const JointVector& q, double grasp) noexcept {
    next_ = q;
    nextGrasp_ = grasp;
    arm_.place(next_, base_, nextFrames_, nextGrasp_);
    places_.place(nextFrames_, origin_, nextLeaves_);
}

void ArmProxy::tryStep(const JointVector& dq, double share) noexcept {
    JointVector q{};
    for (size_t k = 0; k < n_; ++k) {
        q[k] = clampedJoint(k, q_[k] + share * dq[k]);
    }
    tryPosture(q, grasp_);
}

void ArmProxy::take() noexcept {
    q_ = next_;
    grasp_ = nextGrasp_;
    frames_ = nextFrames_;
    leaves_.swap(nextLeaves_);
}

double ArmProxy::shareToCap(const JointVector& dq) noexcept {
    double share = 1.0;
    for (int k = 0; k < 12; ++k) {
        tryStep(dq, share);
        const double travel = leafDisplacement(leaves_, nextLeaves_);
        if (travel <= options_.stepCap) {
            return share;
        }
        share *= 0.999 * options_.stepCap / travel;
    }
    tryStep(dq, 0.0);
    return 0.0;
}

// No leaf ends deeper in a shape than it was, and the tip no farther off a line that it is bound to.
bool ArmProxy::shapesAllow() const noexcept {
    for (const Shape& shape : shapes_) {
        if (shape.isEquality()) {
            if (!proxy::equalityAllows(shape, arm_.tip(frames_), arm_.tip(nextFrames_))) {
                return false;
            }
            continue;
        }
        for (size_t leaf = 0; leaf < arm_.leaves.size(); ++leaf) {
            const double r = arm_.leaves[leaf].sphere.radius;
            const double gap = gapTo(shape, nextLeaves_[leaf] + origin_, r).gap;
            if (gap < 0.0 && !(gap >= std::min(0.0, gapTo(shape, leaves_[leaf] + origin_, r).gap))) {
                return false;
            }
        }
    }
    return true;
}

// violating: leaves that some pair forbids; 0 with false = the trust region or a shape does.
bool ArmProxy::allowed(const ContactSet* contacts, size_t& violating) noexcept {
    violating = contacts == nullptr ? 0 : narrow_.check(*contacts, nextLeaves_, exempt_, violations_);
    return violating == 0 && (contacts == nullptr || trust_.contains(*contacts, nextLeaves_)) &&
           shapesAllow();
}

double ArmProxy::bisect(const JointVector& dq, double most, const ContactSet* contacts) noexcept {
    double good = 0.0, bad = most;
    for (int k = 0; k < proxy::kBisections; ++k) {
        const double middle = 0.5 * (good + bad);
        size_t violating = 0;
        tryStep(dq, middle);
        (allowed(contacts, violating) ? good : bad) = middle;
    }
    tryStep(dq, good);
    return good;
}

// Solves, cuts to the caps, checks exactly; strengthens and solves again; at last shortens. Returns the
// share.
double ArmProxy::fit(JointVector& dq, const Goal& goal, const ContactSet* contacts, ArmStep& out) noexcept {
    double share = 1.0;
    bool cut = false; // by the trust region
    for (int round = 0; round < proxy::kRounds; ++round) {
        size_t violating = 0;
        share = shareToCap(dq);
        if (allowed(contacts, violating)) {
            return share;
        }
        const bool pairs = tighten(violating, share), sides = tightenShapes(share);
        const bool shapes = tightenEqualities(share) || sides;
        cut = violating == 0 && !shapes;
        JointVector other{};
        if (!(pairs || shapes) || solver_.solve(std::span(goal.wanted.data(), n_),
                                                std::span(other.data(), n_)) != SolveStatus::Optimal) {
            break;
        }
        dq = other;
    }
    out.stalled = out.stalled || (cut && contacts != nullptr);
    return bisect(dq, share, contacts);
}

// Where rows that ask for motion contradict each other, they ask for no worse than now.
bool ArmProxy::solveRows(const Goal& goal, JointVector& dq, ArmStep& out) noexcept {
    const std::span<const double> wanted(goal.wanted.data(), n_);
    if (solver_.solve(wanted, std::span(dq.data(), n_)) == SolveStatus::Optimal) {
        return true;
    }
    ++out.infeasible;
    for (size_t i = 0; i < solver_.rows(); ++i) {
        solver_.setOffset(i, std::min(0.0, solver_.offset(i)));
    }
    return solver_.solve(wanted, std::span(dq.data(), n_)) == SolveStatus::Optimal;
}

// One linearisation. True when another one may bring the tip nearer.
bool ArmProxy::step(const ArmInput& input, ArmStep& out) noexcept {
    collectRows(input.contacts, out.solves == 0, out);
    const Goal goal = aim(input, out);
    ++out.solves;
    JointVector dq{};
    if (!solveRows(goal, dq, out)) {
        out.trapped = out.solves == 1;
        activeCount_ = 0;
        return false;
    }
    recordActive(out);
    const double share = fit(dq, goal, input.contacts, out);
    if (share == 0.0) {
        return false;
    }
    // What arcs and raised offsets add must not carry the tip away from a hand that is still.
    const double before = lengthOf(remaining(tip(), input.target), input.metricRadius);
    const double after = lengthOf(remaining(arm_.tip(nextFrames_), input.target), input.metricRadius);
    if (!out.escape && after >= before && before > proxy::kNothing) {
        return false;
    }
    escapeLeft_ *= 1.0 - share;
    const double travel = leafDisplacement(leaves_, nextLeaves_);
    take();
    return travel > proxy::kNothing;
}

} // namespace fathom
