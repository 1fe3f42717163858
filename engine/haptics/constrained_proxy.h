// SPDX-License-Identifier: Apache-2.0
// The step of the proxy, for a free tool and for an arm: collect rows, solve, cut to the caps, check exactly,
// tighten and solve again, bisect, move.
#pragma once

#include "engine/haptics/leaf_contacts.h"
#include "engine/haptics/near_shapes.h"
#include "engine/haptics/proxy_kinematics.h"
#include "engine/haptics/proxy_rows.h"
#include "engine/haptics/proxy_step.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <utility>

namespace fathom {

// One thread. Allocates in the constructor only; step() is noexcept, never locks, throws or waits. An exact
// check of every listed pair before each move guarantees: no gap is below min(0, gap before) at the end of
// the move or on the straight path to it. So a leaf never enters a sphere, and an overlap that new data
// caused never grows. The same holds for shapes at the end of each move. Pairs that would hold a leaf behind
// a surface are exempt (BehindTracker).
//
// The template parameter (ToolKinematics, ArmKinematics) defines how the leaves move.
template <ProxyKinematics Kinematics>
class ConstrainedProxy {
public:
    // True when this set may become the active one for the present leaf positions.
    bool accepts(const ContactSet& contacts) noexcept {
        contacts_.leaves.origin = contacts.origin;
        kinematics_.place(contacts_.leaves);
        return TrustRegion::allows(contacts, contacts_.leaves.now);
    }
    // Replaces the shapes from the next tick on, at most kMaxShapes. A shape that now overlaps a leaf pushes
    // it out gradually, like new data; a keep_in shape holds only those leaves of an arm that are inside now,
    // or that it held before.
    void setShapes(std::span<const Shape> shapes) noexcept {
        contacts_.setShapes(shapes);
        chooseHeld(std::numeric_limits<double>::infinity());
    }
    std::span<const Shape> shapes() const noexcept { return contacts_.shapes(); }
    static constexpr size_t kMaxShapes = LeafContacts::kMaxShapes;

protected:
    using Answer = typename Kinematics::Answer;
    using Step = typename Kinematics::Step;

    ConstrainedProxy(const Tool& leaves, std::span<const Shape> shapes, const ProxyOptions& options,
                     Kinematics&& kinematics)
        : options_(options)
        , kinematics_(std::move(kinematics))
        , contacts_(leaves, shapes, options.stepCap, options.rows)
        , rows_(kinematics_.unknowns(), options.rows)
        , nearShapes_(leaves.leafCount(), std::max(kMaxShapes, shapes.size())) {}

    // Which leaves the keep_in shapes hold: those inside now, and those held before and now at most `keeps`
    // [m] outside. All leaves of a free tool.
    void chooseHeld(double keeps) noexcept {
        if constexpr (Kinematics::kHoldsOnlyInside) {
            kinematics_.place(contacts_.leaves);
            contacts_.chooseHeld(keeps);
        }
    }
    // One tick: begin(), then finish() if begin() returned true (the set is usable), then report().
    bool begin(const ProxyInput& input) noexcept;
    void finish(const ProxyInput& input, Step& out) noexcept;
    void report(Step& out) noexcept;
    // Lists the leaves that two motions of at most the step cap from here can bring into a shape.
    void findNearShapes() noexcept;
    // True when at the tried pose no leaf violates a pair, leaves the trust region or gets deeper into a
    // shape.
    bool allowed(bool insideTrustRegion) noexcept;

    ProxyOptions options_;
    Kinematics kinematics_;
    LeafContacts contacts_;
    ProxyRows rows_;
    NearShapes nearShapes_;

private:
    static constexpr int kRounds = 8;
    static constexpr int kBisections = 14;

    bool linearise(bool first, Step& out) noexcept;
    void collectRows(bool first, Step& out) noexcept;
    void addSmoothRows() noexcept;
    void addShapeRows(Step& out) noexcept;
    bool addShapeRows(uint32_t shape, uint32_t leaf) noexcept;
    ContactRow shapeRow(uint32_t shape, uint32_t leaf, size_t side, const SideGap& gap) const noexcept;
    void addEqualityRows(const Shape& shape, uint32_t index) noexcept;
    bool addRow(ContactRow row) noexcept { return kinematics_.addRow(row, contacts_.leaves, rows_); }
    double offsetFor(double gap) const noexcept;
    bool fitsExactly(Answer& answer, Step& out) noexcept;
    bool tighten(const Answer& answer) noexcept;
    bool tightenShapes(double tried) noexcept;
    bool addMissingShapeRow() noexcept;
    bool late() const noexcept { return deadline_.passed != nullptr && deadline_.passed(deadline_.context); }
    bool shapesAllow() const noexcept;
    double bisect(const Answer& answer) noexcept;

    Deadline deadline_;
    bool everyShapeRow_ = true;          // each leaf near a shape has its rows
    bool onlyTrustRegionFailed_ = false; // in the last bisection
};

template <ProxyKinematics Kinematics>
bool ConstrainedProxy<Kinematics>::begin(const ProxyInput& input) noexcept {
    rows_.clearActive();
    kinematics_.begin(input, rows_);
    const bool usable = contacts_.use(input.contacts, kinematics_.origin());
    kinematics_.place(contacts_.leaves);
    return usable;
}

template <ProxyKinematics Kinematics>
void ConstrainedProxy<Kinematics>::finish(const ProxyInput& input, Step& out) noexcept {
    if (!isFinite(input.target)) { // hold
        return;
    }
    deadline_ = input.deadline;
    for (uint32_t k = 0; k < options_.solves; ++k) {
        if (k > 0 && late()) {
            return;
        }
        if (!linearise(k == 0, out)) {
            return;
        }
    }
}

template <ProxyKinematics Kinematics>
void ConstrainedProxy<Kinematics>::report(Step& out) noexcept {
    out.pose = kinematics_.pose();
    if (!out.cut) {
        out.allowed = out.pose;
    }
    out.active = rows_.active();
    out.minGap = contacts_.smallestGap();
    kinematics_.report(out);
}

// One linearisation. True when another one may get nearer to the target.
template <ProxyKinematics Kinematics>
bool ConstrainedProxy<Kinematics>::linearise(bool first, Step& out) noexcept {
    out.cut = out.rowsExpired = false;
    collectRows(first, out);
    if (!kinematics_.beginLinearisation(rows_, out)) {
        return false;
    }
    ++out.solves;
    Answer answer;
    if (!kinematics_.solve(answer, false, rows_, out)) {
        out.trapped = out.solves == 1; // later solves of a tick keep their progress and their rows
        if (out.trapped) {
            rows_.clearActive();
        }
        return false;
    }
    const bool fits = fitsExactly(answer, out);
    out.bisected += fits ? 0 : 1;
    const double fraction = fits ? kinematics_.fullFraction(answer) : bisect(answer);
    out.stalled = out.stalled || answer.stalled;
    kinematics_.recordAllowed(answer, !fits && !onlyTrustRegionFailed_, contacts_, rows_, out);
    const StepOutcome outcome = kinematics_.outcomeOf(answer, fraction, contacts_.leaves, rows_, out);
    if (outcome != StepOutcome::None) {
        kinematics_.commit();
        contacts_.leaves.now.swap(contacts_.leaves.next);
    }
    return outcome == StepOutcome::More;
}

// Cuts, checks, tightens and solves again until the exact check passes. On return `answer` holds the last
// solution; true when all of it passed.
template <ProxyKinematics Kinematics>
bool ConstrainedProxy<Kinematics>::fitsExactly(Answer& answer, Step& out) noexcept {
    for (int round = 0;; ++round) {
        const bool inside = kinematics_.cutAndTry(answer, contacts_, rows_);
        if (allowed(inside)) {
            return true;
        }
        if (round > 0 && late()) {
            return false;
        }
        const bool changed = tighten(answer);
        if (!changed && contacts_.violations().empty()) {
            answer.stalled = answer.stalled || (!inside && contacts_.set() != nullptr);
        }
        const bool last = round + 1 == kRounds;
        if (!changed || (last && !Kinematics::kSolvesLastRound)) {
            return false;
        }
        ++out.rounds;
        if (!kinematics_.solve(answer, true, rows_, out) || last) {
            return false;
        }
    }
}

template <ProxyKinematics Kinematics>
bool ConstrainedProxy<Kinematics>::allowed(bool insideTrustRegion) noexcept {
    return contacts_.check() == 0 && (insideTrustRegion || contacts_.insideTrustRegion()) && shapesAllow();
}

template <ProxyKinematics Kinematics>
bool ConstrainedProxy<Kinematics>::shapesAllow() const noexcept {
    for (const Shape& shape : shapes()) {
        if (shape.isEquality() && !equalityAllows(shape, kinematics_.pose(), kinematics_.nextPose())) {
            return false;
        }
    }
    for (const NearShapes::Pair& pair : nearShapes_.pairs()) {
        const Shape& shape = shapes()[pair.shape];
        const double radius = contacts_.radius(pair.leaf);
        const double gap = gapTo(shape, kinematics_.leafNext(pair.leaf, contacts_.leaves), radius).gap;
        if (gap >= 0.0) {
            continue;
        }
        const dvec3 now = kinematics_.leafNow(pair.leaf, contacts_.leaves);
        if (!(gap >= std::min(0.0, gapTo(shape, now, radius).gap))) {
            return false;
        }
    }
    return true;
}

// Largest part of the step, to 1/2^14 of it, that passes the exact check and the trust region. 0 always
// passes.
template <ProxyKinematics Kinematics>
double ConstrainedProxy<Kinematics>::bisect(const Answer& answer) noexcept {
    double good = 0.0, bad = kinematics_.fullFraction(answer);
    onlyTrustRegionFailed_ = true;
    for (int k = 0; k < kBisections && (k == 0 || !late()); ++k) {
        const double middle = 0.5 * (good + bad);
        kinematics_.tryFraction(answer, middle, contacts_.leaves);
        const bool fits = allowed(false);
        (fits ? good : bad) = middle;
        onlyTrustRegionFailed_ =
            onlyTrustRegionFailed_ && (fits || (contacts_.check() == 0 && shapesAllow()));
    }
    kinematics_.tryFraction(answer, good, contacts_.leaves);
    return good;
}

} // namespace fathom
