// SPDX-License-Identifier: Apache-2.0
// One linearisation: solve, scale to the step cap and the trust region, check every pair exactly, and only
// then move.
#include "engine/haptics/proxy.h"

#include "engine/haptics/proxy_limits.h"
#include "engine/haptics/row_rules.h"

#include <algorithm>
#include <cmath>

namespace fathom {

namespace {

using proxy::kNothing;

constexpr double kSettling = 1e-8; // [m] travel too small to be felt: 1e-5 N at 1000 N/m

bool isNothing(const Motion& m) {
    return glm::length(m.a) <= kNothing && glm::length(m.alpha) <= kNothing;
}

bool same(const Motion& m, const Motion& o) {
    return m.a == o.a && m.alpha == o.alpha;
}

} // namespace

// Share of every row's offset that the fitted motion is sure of: `escape` and `full` both obey all rows.
double Proxy::answered(const Step& step) noexcept {
    return step.escapeShare * (1.0 - step.towards) + step.towards;
}

// Largest share of `rest` after `first` with no leaf farther than the cap: exact travel, from below.
double Proxy::shareToCap(const Motion& first, const Motion& rest, double firstBound) noexcept {
    const double cap = options_.stepCap;
    const auto travel = [&](double s) {
        places_.place(moved(pose_, first + s * rest), origin_, next_);
        return leafDisplacement(leaves_, next_);
    };
    if (places_.crudeBound(first + rest) <= cap || travel(1.0) <= cap) {
        return 1.0;
    }
    const double restBound = places_.travelBound(pose_, rest);
    double s = std::clamp((cap - firstBound) / restBound, 0.0, 1.0);
    // The bound adds translation and rotation as if they always agreed: take what it gave away.
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

// Cuts the answer to the caps and the trust region; leaves nextPose_ and next_ where that leads.
void Proxy::fit(const ProxyInput& input, const Motion& wanted, const Budget& budget, Step& step) noexcept {
    double escapeBound = 0.0;
    step.escapeShare = 0.0;
    step.share = 1.0;
    if (escaping_) {
        const double bound = places_.travelBound(pose_, step.escape);
        step.escapeShare = bound > budget.travel ? budget.travel / bound : 1.0;
        escapeBound = bound * step.escapeShare;
    }
    const Motion first = step.escapeShare * step.escape;
    step.towards = shareToCap(first, step.full - first, escapeBound);
    step.whole = step.towards == 1.0 && same(step.full, wanted);
    tryPose(input, step, 1.0);
    if (input.contacts == nullptr || trust_.surelyContains(places_.crudeBound(motionOf(step, 1.0))) ||
        trust_.contains(*input.contacts, next_)) {
        return;
    }
    step.whole = false;
    step.share = trust_.share(*input.contacts, leaves_, next_);
    for (int k = 0; k < 24; ++k) { // leaves turn on arcs, the share was for straight ways
        tryPose(input, step, 1.0);
        if (trust_.contains(*input.contacts, next_)) {
            return;
        }
        step.share *= k < 6 ? 0.98 : 0.5;
    }
    step.share = 0.0;
    tryPose(input, step, 1.0);
}

Motion Proxy::motionOf(const Step& step, double part) noexcept {
    const Motion first = step.escapeShare * step.escape;
    return (step.share * part) * (first + step.towards * (step.full - first));
}

// The pose that `part` of the fitted step leads to, and its leaves.
void Proxy::tryPose(const ProxyInput& input, const Step& step, double part) noexcept {
    if (step.whole && part == 1.0) {
        nextPose_ = {input.target.position, glm::normalize(input.target.rotation)};
    } else {
        nextPose_ = moved(pose_, motionOf(step, part));
    }
    places_.place(nextPose_, origin_, next_);
}

bool Proxy::shapesAllow() noexcept {
    for (const Shape& shape : shapes_) {
        if (shape.isEquality()) {
            if (!proxy::equalityAllows(shape, pose_, nextPose_)) {
                return false;
            }
            continue;
        }
        for (size_t leaf = 0; leaf < radius_.size(); ++leaf) {
            const dvec3 end = nextPose_.position + nextPose_.rotation * places_.centre(leaf);
            const double gap = gapTo(shape, end, radius_[leaf]).gap;
            if (gap >= 0.0) {
                continue;
            }
            const dvec3 start = pose_.position + pose_.rotation * places_.centre(leaf);
            if (!(gap >= std::min(0.0, gapTo(shape, start, radius_[leaf]).gap))) {
                return false;
            }
        }
    }
    return true;
}

bool Proxy::isAllowed(const ContactSet* contacts, size_t& violating) noexcept {
    violating = contacts == nullptr ? 0 : narrow_.check(*contacts, next_, exempt_, violations_);
    return violating == 0 && shapesAllow();
}

// Largest part of the step, to 1/2^14, that passes both the exact check and the trust region; 0 always does.
double Proxy::bisect(const ProxyInput& input, const Step& step) noexcept {
    double allowed = 0.0, refused = 1.0;
    for (int k = 0; k < proxy::kBisections; ++k) {
        const double part = 0.5 * (allowed + refused);
        size_t violating = 0;
        tryPose(input, step, part);
        const bool inside = input.contacts == nullptr || trust_.contains(*input.contacts, next_);
        (inside && isAllowed(input.contacts, violating) ? allowed : refused) = part;
    }
    return allowed;
}

// Solves and strengthens until the exact check passes. On return `step` holds the last answer; true when it
// passed as a whole.
bool Proxy::fitsExactly(const ProxyInput& input, const Motion& wanted, const Budget& budget, Step& step,
                        ProxyStep& out) noexcept {
    for (int round = 0; round < proxy::kRounds; ++round) {
        fit(input, wanted, budget, step);
        size_t violating = 0;
        if (isAllowed(input.contacts, violating)) {
            return true;
        }
        const double share = step.share * answered(step);
        const bool pairs = tighten(motionOf(step, 1.0), violating, share);
        const bool shapes = tightenShapes(share);
        if (round + 1 == proxy::kRounds || !(pairs || shapes)) {
            return false;
        }
        ++out.rounds;
        if (!solveRows(wanted, step, out)) {
            return false;
        }
    }
    return false;
}

// True when the next pose lies nearer to the target by the metric: when the springs' energy falls. The
// solver's answer does so by its linearisation; what arcs and raised offsets add can undo it where the rows
// of several leaves meet, and then the tool would dance about the place although the hand is still. Written
// so that a target far away costs no digits. Steps of rounding size pass: they settle the tool, and their
// energy is below what a position far from the base origin can tell.
bool Proxy::comesNearer(const Pose& target, const Motion& taken) const noexcept {
    if (glm::length(taken.a) <= kSettling && glm::length(taken.alpha) * metricRadius_ <= kSettling) {
        return true;
    }
    const Motion now = remaining(pose_, target), next = remaining(nextPose_, target);
    const double turning = glm::dot(next.alpha - now.alpha, next.alpha + now.alpha);
    return glm::dot(next.a - now.a, next.a + now.a) + metricRadius_ * metricRadius_ * turning < 0.0;
}

// One linearisation. True when another one may bring the tool nearer.
bool Proxy::step(const ProxyInput& input, Budget& budget, ProxyStep& out) noexcept {
    collectRows(input.contacts, budget);
    const bool newData = escaping_; // rows raised for arcs ask too, later
    out.escape = out.escape || touching_;
    const Motion wanted = remaining(pose_, input.target);
    if (out.solves > 0 && !escaping_ && isNothing(wanted)) {
        return false;
    }
    ++out.solves;
    Step answer;
    if (!solveRows(wanted, answer, out)) {
        out.trapped = out.solves == 1; // later in a turn: what was gained stays, the next turn tries again
        activeCount_ = 0;
        return false;
    }
    double part = 1.0;
    if (!fitsExactly(input, wanted, budget, answer, out)) {
        ++out.bisected;
        part = bisect(input, answer);
        tryPose(input, answer, part);
    }
    out.stalled = out.stalled || answer.share < 1.0;
    const Motion taken = remaining(pose_, nextPose_);
    if (isNothing(taken) && escaping_ &&
        part < 1.0) { // rows that only a motion far away would obey: no way out here
        out.trapped = out.solves == 1;
        activeCount_ = 0;
    }
    if (part == 0.0 || (!newData && !comesNearer(input.target, taken))) {
        return false;
    }
    const double done = part * answer.share;
    budget.depth = std::max(0.0, budget.depth - done * answered(answer) * largestAsked_);
    if (escaping_) {
        budget.travel -= done * answer.escapeShare * places_.travelBound(pose_, answer.escape);
    }
    pose_ = nextPose_;
    leaves_.swap(next_);
    return !isNothing(taken);
}

} // namespace fathom
