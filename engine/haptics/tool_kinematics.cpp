// SPDX-License-Identifier: Apache-2.0
#include "engine/haptics/tool_kinematics.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace fathom {

namespace {

using proxy::kNegligible;

constexpr double kSettling = 1e-8; // [m] travel too small to be felt: 1e-5 N at 1000 N/m

bool isNothing(const Motion& m) {
    return glm::length(m.a) <= kNegligible && glm::length(m.alpha) <= kNegligible;
}

std::array<double, 6> unknownsOf(const Motion& m) {
    return {m.a.x, m.a.y, m.a.z, m.alpha.x, m.alpha.y, m.alpha.z};
}

} // namespace

ToolKinematics::ToolKinematics(const Tool& tool, const ProxyOptions& options, const Pose& start)
    : places_(tool)
    , boundingRadius_(tool.boundingRadius())
    , stepCap_(options.stepCap)
    , escape_(ProxyOptions::kEscapeSpeed * options.period)
    , catchUp_(ProxyOptions::kCatchUp * options.period)
    , mostTravel_(options.solves * options.stepCap)
    , friction_(options.friction)
    , pose_{start.position, glm::normalize(start.rotation)} {}

void ToolKinematics::setPose(const Pose& pose) noexcept {
    if (isFinite(pose)) {
        pose_ = {pose.position, glm::normalize(pose.rotation)};
    }
}

void ToolKinematics::begin(const ProxyInput& input, ProxyRows& rows) noexcept {
    // The tool may travel as far as the target did, plus a little to make up for a lag.
    const double carried = std::min(cutTravel_, budget_.follow);
    const double byHand = hasTarget_ ? places_.travelBound(pose_, remaining(target_, input.target))
                                     : std::numeric_limits<double>::infinity();
    const double moved = input.surfaceMoved ? std::max(byHand, mostTravel_) : byHand;
    target_ = input.target;
    hasTarget_ = true;
    cutTravel_ = 0.0;
    budget_ = {escape_, stepCap_, carried + moved + catchUp_};
    setMetric(input.metricRadius, rows);
}

void ToolKinematics::setMetric(double radius, ProxyRows& rows) noexcept {
    // Kept within what float64 can factor, so that setMetric() cannot reject it.
    const double k = std::isfinite(radius) ? std::clamp(radius, 1e-4, 1e4) : 0.1;
    if (k == metricRadius_) {
        return;
    }
    metricRadius_ = k;
    std::array<double, 36> metric{};
    for (size_t i = 0; i < 6; ++i) {
        metric[i * 7] = i < 3 ? 1.0 : k * k;
    }
    rows.setMetric(metric);
}

bool ToolKinematics::addRow(const ContactRow& row, const LeafState&, ProxyRows& rows) const noexcept {
    return rows.add(row, unknownsOf({row.normal, glm::cross(row.arm, row.normal) + row.spin}));
}

bool ToolKinematics::beginLinearisation(const ProxyRows& rows, const ProxyStep& out) noexcept {
    newData_ = rows.escaping();
    wanted_ = remaining(pose_, target_);
    return out.solves == 0 || newData_ || !isNothing(wanted_);
}

bool ToolKinematics::solveFor(const Motion& wanted, Motion& motion, ProxyRows& rows,
                              ProxyStep& out) const noexcept {
    const std::array<double, 6> target = unknownsOf(wanted);
    std::array<double, 6> x{};
    bool optimal = true;
    do {
        optimal = rows.solve(target, x) || (rows.relax() && rows.solve(target, x));
    } while (optimal && rows.loadViolated(x));
    motion = {dvec3(x[0], x[1], x[2]), dvec3(x[3], x[4], x[5])};
    out.infeasible += optimal ? 0 : 1;
    return optimal;
}

bool ToolKinematics::solve(Answer& answer, bool, ProxyRows& rows, ProxyStep& out) const noexcept {
    rows.load(unknownsOf(wanted_));
    Answer found;
    if ((rows.escaping() && !solveFor(Motion{}, found.escape, rows, out)) ||
        !solveFor(wanted_, found.full, rows, out)) {
        return false;
    }
    rows.recordActive();
    Motion stuck;
    if (friction_ > 0.0 && !rows.escaping()) {
        stuck = applyFriction(found.full, rows, out);
    }
    out.stuck = stuck.a;
    out.stuckTurn = stuck.alpha;
    answer = found;
    return true;
}

// Friction as a play: shortens the sliding part of the solution, across the reaction, by mu times the
// distance that the rows take from the target. At rest the spring then also pulls sideways, by at most mu
// times the reaction. The tool still only moves nearer to the target, so friction stores no energy that the
// hand did not give. Returns what it took off.
Motion ToolKinematics::applyFriction(Motion& full, ProxyRows& rows, ProxyStep& out) const noexcept {
    const Motion back = wanted_ - full;
    if (isNothing(back)) {
        return {};
    }
    const double held = lengthOf(back, metricRadius_);
    const double along = productOf(full, back, metricRadius_) / (held * held);
    const Motion sliding = full - along * back;
    Motion rest = full - std::min(1.0, friction_ * held / divisorOf(sliding, metricRadius_)) * sliding;
    // Spheres of one surface have rows at slightly different angles: a shorter way may violate some.
    if (rows.active().size() > 1 && !solveFor(rest, rest, rows, out)) {
        return {};
    }
    const Motion stuck = full - rest;
    full = rest;
    return stuck;
}

// Largest part of `rest` after `first` that moves no leaf beyond the cap. Uses exact travel; errs on the
// small side.
double ToolKinematics::fractionToCap(const Motion& first, const Motion& rest, double firstBound, double cap,
                                     LeafState& leaves) const noexcept {
    const auto travel = [&](double s) {
        places_.place(moved(pose_, first + s * rest), leaves.origin, leaves.next);
        return leaves.travel();
    };
    if (places_.crudeBound(first + rest) <= cap || travel(1.0) <= cap) {
        return 1.0;
    }
    double s = std::clamp((cap - firstBound) / places_.travelBound(pose_, rest), 0.0, 1.0);
    // The bound adds translation and rotation as if they were parallel; recover the difference.
    double reached = travel(s);
    for (int k = 0; k < 3 && reached > 0.0 && reached < 0.98 * cap && s > 0.0; ++k) {
        const double longer = std::min(1.0, s * cap / reached * (1.0 - 1e-9));
        const double there = travel(longer);
        if (there > cap) {
            break;
        }
        s = longer;
        reached = there;
    }
    return s;
}

// Cuts the solution to the caps and the trust region and tries the rest.
bool ToolKinematics::cutAndTry(Answer& answer, LeafContacts& contacts, const ProxyRows& rows) noexcept {
    LeafState& leaves = contacts.leaves;
    double escapeBound = 0.0;
    answer.escapeFraction = 0.0;
    answer.trustFraction = 1.0;
    if (rows.escaping()) {
        const double bound = places_.travelBound(pose_, answer.escape);
        answer.escapeFraction = bound > budget_.travel ? budget_.travel / bound : 1.0;
        escapeBound = bound * answer.escapeFraction;
    }
    const Motion first = answer.escapeFraction * answer.escape;
    // Along a region the tool may have to travel farther than the hand.
    const double follow = rows.active().empty() ? escapeBound + budget_.follow : stepCap_;
    answer.targetFraction =
        fractionToCap(first, answer.full - first, escapeBound, std::min(stepCap_, follow), leaves);
    answer.whole =
        answer.targetFraction == 1.0 && answer.full.a == wanted_.a && answer.full.alpha == wanted_.alpha;
    answer.stalled = false;
    tryFraction(answer, 1.0, leaves);
    if (contacts.set() == nullptr ||
        contacts.trust().surelyContains(places_.crudeBound(motionOf(answer, 1.0))) ||
        contacts.insideTrustRegion()) {
        return true;
    }
    answer.whole = false;
    answer.trustFraction = contacts.trust().share(*contacts.set(), leaves.now, leaves.next);
    for (int k = 0; k < 24; ++k) { // leaves move on arcs, but the fraction is for straight paths
        tryFraction(answer, 1.0, leaves);
        answer.stalled = answer.trustFraction < 1.0;
        if (contacts.insideTrustRegion()) {
            return true;
        }
        answer.trustFraction *= k < 6 ? 0.98 : 0.5;
    }
    answer.trustFraction = 0.0;
    answer.stalled = true;
    tryFraction(answer, 1.0, leaves);
    return true;
}

Motion ToolKinematics::motionOf(const Answer& answer, double fraction) noexcept {
    const Motion first = answer.escapeFraction * answer.escape;
    return (answer.trustFraction * fraction) * (first + answer.targetFraction * (answer.full - first));
}

void ToolKinematics::tryFraction(const Answer& answer, double fraction, LeafState& leaves) noexcept {
    if (answer.whole && fraction == 1.0) {
        nextPose_ = {target_.position, glm::normalize(target_.rotation)};
    } else {
        nextPose_ = moved(pose_, motionOf(answer, fraction));
    }
    places_.place(nextPose_, leaves.origin, leaves.next);
}

// True when the next pose is nearer to the target in the metric, that is, when the springs' energy falls. It
// falls for the linearised solution, but arcs and raised offsets can undo that where rows of several leaves
// meet, and the tool would oscillate although the hand is still. The formula loses no digits for a far
// target. Steps of rounding size pass: they settle the tool, and their energy is below the resolution of a
// position far from the base origin.
bool ToolKinematics::comesNearer(const Motion& taken) const noexcept {
    if (glm::length(taken.a) <= kSettling && glm::length(taken.alpha) * metricRadius_ <= kSettling) {
        return true;
    }
    const Motion next = remaining(nextPose_, target_);
    const double rotation = glm::dot(next.alpha - wanted_.alpha, next.alpha + wanted_.alpha);
    return glm::dot(next.a - wanted_.a, next.a + wanted_.a) + metricRadius_ * metricRadius_ * rotation < 0.0;
}

StepOutcome ToolKinematics::outcomeOf(const Answer& answer, double fraction, const LeafState& leaves,
                                      ProxyRows& rows, ProxyStep& out) noexcept {
    const Motion taken = remaining(pose_, nextPose_);
    if (isNothing(taken) && rows.escaping() &&
        fraction < 1.0) { // only a far motion would satisfy the rows: no way out
        out.trapped = out.solves == 1;
        if (out.trapped) {
            rows.clearActive();
        }
    }
    if (fraction == 0.0 || (!newData_ && !comesNearer(taken))) {
        return StepOutcome::None;
    }
    const double done = fraction * answer.trustFraction;
    budget_.depth = std::max(0.0, budget_.depth - done * answered(answer) * rows.largestEscape());
    double escaped = 0.0;
    if (rows.escaping()) {
        escaped = done * answer.escapeFraction * places_.travelBound(pose_, answer.escape);
        budget_.travel -= escaped;
    }
    budget_.follow = std::max(0.0, budget_.follow - std::max(0.0, leaves.travel() - escaped));
    return isNothing(taken) ? StepOutcome::Last : StepOutcome::More;
}

void ToolKinematics::report(ProxyStep& out) const noexcept {
    const Motion left = remaining(pose_, target_);
    const bool apart = glm::length(left.a) > kSettling || glm::length(left.alpha) * metricRadius_ > kSettling;
    out.blocked = apart && out.active.empty() && !out.cut && !out.trapped;
    out.contact = !out.active.empty() || out.blocked;
}

void ToolKinematics::recordAllowed(const Answer& answer, bool blocked, const LeafContacts& contacts,
                                   const ProxyRows& rows, ProxyStep& out) noexcept {
    const bool shortened = answer.targetFraction < 1.0 || answer.trustFraction < 1.0;
    // What only the step cap cut may be made up for in the next tick.
    const bool cut = answer.trustFraction == 1.0 && answer.targetFraction < 1.0;
    const Motion rest = answer.full - answer.escapeFraction * answer.escape;
    cutTravel_ = cut ? (1.0 - answer.targetFraction) * places_.travelBound(pose_, rest) : 0.0;
    out.cut = shortened && !blocked;
    out.rowsExpired =
        shortened && places_.travelBound(pose_, answer.full) > contacts.tangentTravel(rows.active());
    if (out.cut) {
        const bool target = answer.full.a == wanted_.a && answer.full.alpha == wanted_.alpha;
        out.allowed = target ? target_ : moved(pose_, answer.full);
    }
}

double ToolKinematics::shortfall(const NarrowPhase::Violation& violation, double needed,
                                 const LeafState& leaves) const noexcept {
    const ContactRow& row = violation.row;
    return std::max(violation.depth,
                    needed - glm::dot(row.normal, leaves.next[row.leaf] - leaves.now[row.leaf]));
}

// [m] shortfall of the tried motion's arc against its linearisation along the row.
double ToolKinematics::arcOf(const Answer& answer, const ContactRow& row,
                             const LeafState& leaves) const noexcept {
    const Motion tried = motionOf(answer, 1.0);
    const dvec3 displacement = leaves.next[row.leaf] - leaves.now[row.leaf];
    const double arc = glm::dot(row.normal, tried.a + glm::cross(tried.alpha, row.arm) - displacement);
    return std::max(0.0, arc) * scaleOf(triedFraction(answer));
}

} // namespace fathom
