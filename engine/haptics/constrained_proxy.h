// SPDX-License-Identifier: Apache-2.0
// The step that a free tool and an arm share: collect rows, solve, cut to the caps, check exactly, tighten
// and solve again, bisect, move.
#pragma once

#include "engine/haptics/leaf_contacts.h"
#include "engine/haptics/proxy_rows.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>

namespace fathom {

// How a proxy moves; fixed when it is made.
struct ProxyOptions {
    double stepCap = 0.002;       // [m] farthest that a leaf centre travels in one solve
    uint32_t solves = 4;          // linearisations per tick, at most
    double escapePerTick = 0.001; // [m] depth given back per tick where new data lies over a leaf
    RowReduction rows;
};

// True when the tick should end: asked between solves. Must not throw, lock or allocate.
struct Deadline {
    bool (*passed)(const void* context) = nullptr; // null = none
    const void* context = nullptr;
};

// What a tick asks of the proxy.
struct ProxyInput {
    Pose target;               // base_T_tool (of an arm: base_T_tip) that the hand and guidance ask for
    double metricRadius = 0.1; // [m] k = sqrt(K_r / K_t); 0, arm only = the tip's direction is free
    // The active set, which must outlive the tick; null = the scene has no regions of points. Adopt a new set
    // only when covers() accepts it: otherwise spheres that neither set lists could lie between.
    const ContactSet* contacts = nullptr;
    Deadline deadline;
};

// The result of a tick.
struct ProxyStep {
    Pose pose;                             // base_T_tool or base_T_tip after the tick
    std::span<const ActiveContact> active; // valid until the next tick
    double minGap = 0.0;                   // [m] over the contact set; its certified reach if none is nearer
    bool contact = false;                  // some row pushed in the last solve
    bool escape = false;                   // new data lies over a leaf: some listed pair or shape overlaps
    bool trapped = false;    // no motion obeys every row: held this tick, tried again at the next
    bool stalled = false;    // cut by the trust region: waits for the next contact set
    bool uncovered = false;  // the set does not cover the leaves (see ProxyInput::contacts)
    uint32_t solves = 0;     // linearisations
    uint32_t rounds = 0;     // solver calls with tightened rows
    uint32_t infeasible = 0; // solver calls that found no motion
    uint32_t bisected = 0;   // steps that the exact check shortened
};

// How a linearisation ended.
enum class StepOutcome {
    None, // the step is refused
    Last, // taken, but too short to be worth another solve
    More, // taken; another solve may come nearer
};

// One thread. Allocates in the constructor only; step() is noexcept, never locks, throws or waits. An exact
// check of every listed pair before each move keeps this promise: no pair's gap ends below min(0, its gap
// before), nor falls below it on the straight way there. So a leaf never enters a sphere, and a depth that
// new data brought never grows; the same holds for shapes at the end of each move. Exempt are pairs that
// would hold a leaf behind a surface (BehindTracker).
//
// Kinematics says what moves the leaves (ToolKinematics, ArmKinematics): the solver's unknowns and target,
// the rows in these unknowns, how a solution becomes a tried pose and its leaf centres, how far rows may ask
// for motion, and when a step is worth taking. All of it is called directly, without virtual functions.
template <class Kinematics>
class ConstrainedProxy {
public:
    // May this set become the active one for the leaves where they are?
    bool covers(const ContactSet& contacts) noexcept {
        contacts_.leaves.origin = contacts.origin;
        kinematics_.place(contacts_.leaves);
        return TrustRegion::covers(contacts, contacts_.leaves.now);
    }
    // Other shapes from the next tick on; as many as there were at first, or kSpareShapes if that is more. A
    // shape that comes to lie over a leaf lets it out like new data.
    void setShapes(std::span<const Shape> shapes) noexcept { contacts_.setShapes(shapes); }
    std::span<const Shape> shapes() const noexcept { return contacts_.shapes(); }
    static constexpr size_t kSpareShapes = LeafContacts::kSpareShapes;

protected:
    using Answer = typename Kinematics::Answer;
    using Step = typename Kinematics::Step;

    ConstrainedProxy(const Tool& leaves, std::span<const Shape> shapes, const ProxyOptions& options,
                     Kinematics&& kinematics)
        : options_(options)
        , kinematics_(std::move(kinematics))
        , contacts_(leaves, shapes, options.stepCap, options.rows)
        , rows_(kinematics_.unknowns(), options.rows) {}

    // A tick: begin(), and finish() when that is true (the set is usable); then report().
    bool begin(const ProxyInput& input) noexcept;
    void finish(const ProxyInput& input, Step& out) noexcept;
    void report(Step& out) noexcept;
    // No leaf violates a pair, leaves the trust region or gets deeper into a shape at the tried place.
    bool allowed(bool insideTrustRegion) noexcept;

    ProxyOptions options_;
    Kinematics kinematics_;
    LeafContacts contacts_;
    ProxyRows rows_;

private:
    static constexpr int kRounds = 8;
    static constexpr int kBisections = 14;

    bool linearise(bool first, Step& out) noexcept;
    void collectRows(bool first, Step& out) noexcept;
    void addShapeRows(Step& out) noexcept;
    void addEqualityRows(const Shape& shape, uint32_t index) noexcept;
    bool addRow(ContactRow row) noexcept { return kinematics_.addRow(row, contacts_.leaves, rows_); }
    double offsetFor(double gap) const noexcept;
    bool fitsExactly(Answer& answer, Step& out) noexcept;
    bool tighten(const Answer& answer) noexcept;
    bool tightenShapes(double share) noexcept;
    bool shapesAllow() const noexcept;
    double bisect(const Answer& answer) noexcept;
};

template <class Kinematics>
bool ConstrainedProxy<Kinematics>::begin(const ProxyInput& input) noexcept {
    rows_.clearActive();
    kinematics_.begin(input, rows_);
    const bool usable = contacts_.use(input.contacts, kinematics_.origin());
    kinematics_.place(contacts_.leaves);
    return usable;
}

template <class Kinematics>
void ConstrainedProxy<Kinematics>::finish(const ProxyInput& input, Step& out) noexcept {
    if (!isFinite(input.target)) { // hold
        return;
    }
    const ContactSet* set = contacts_.set();
    out.uncovered = set != nullptr && !TrustRegion::covers(*set, contacts_.leaves.now);
    for (uint32_t k = 0; k < options_.solves; ++k) {
        if (k > 0 && input.deadline.passed != nullptr && input.deadline.passed(input.deadline.context)) {
            return;
        }
        if (!linearise(k == 0, out)) {
            return;
        }
    }
}

template <class Kinematics>
void ConstrainedProxy<Kinematics>::report(Step& out) noexcept {
    out.pose = kinematics_.pose();
    out.active = rows_.active();
    out.minGap = contacts_.smallestGap();
    kinematics_.report(out);
}

// One linearisation. True when another one may come nearer to the target.
template <class Kinematics>
bool ConstrainedProxy<Kinematics>::linearise(bool first, Step& out) noexcept {
    collectRows(first, out);
    if (!kinematics_.aim(contacts_.leaves, rows_, out)) {
        return false;
    }
    ++out.solves;
    Answer answer;
    if (!kinematics_.solve(answer, false, rows_, out)) {
        out.trapped = out.solves == 1; // later in a tick: what was gained stays, the next tick tries again
        rows_.clearActive();
        return false;
    }
    const bool fits = fitsExactly(answer, out);
    out.bisected += fits ? 0 : 1;
    const double part = fits ? kinematics_.wholePart(answer) : bisect(answer);
    out.stalled = out.stalled || answer.stalled;
    const StepOutcome outcome = kinematics_.judge(answer, part, contacts_.leaves, rows_, out);
    if (outcome != StepOutcome::None) {
        kinematics_.take();
        contacts_.leaves.now.swap(contacts_.leaves.next);
    }
    return outcome == StepOutcome::More;
}

// Separated: what keeps the leaf out, and the skin. Overlapping: out again, as fast as the tick allows.
template <class Kinematics>
double ConstrainedProxy<Kinematics>::offsetFor(double gap) const noexcept {
    return gap >= 0.0 ? proxy::kSkin - gap : kinematics_.escapeOffset(-gap);
}

template <class Kinematics>
void ConstrainedProxy<Kinematics>::collectRows(bool first, Step& out) noexcept {
    const dvec3 centre = kinematics_.pose().position;
    rows_.clear();
    kinematics_.addLimits(rows_);
    contacts_.gather(centre, first);
    out.escape = out.escape || contacts_.overlaps();
    const bool anyBehind = contacts_.anyBehind();
    for (ContactRow row : contacts_.pairRows()) {
        if (anyBehind && contacts_.holdsBehind(row)) {
            continue; // its way out is added below
        }
        // A tool with a leaf behind a surface has one way out, and other pairs need only not get deeper on
        // it. So close to the sphere centres their own normals point to all sides and would squeeze the tool.
        row.offset = anyBehind && row.gap < 0.0 ? proxy::kSkin : offsetFor(row.gap);
        addRow(row);
    }
    for (ContactRow row : contacts_.behindRows(centre)) {
        row.offset = kinematics_.escapeOffset(-row.gap);
        addRow(row);
    }
    addShapeRows(out);
}

template <class Kinematics>
void ConstrainedProxy<Kinematics>::addShapeRows(Step& out) noexcept {
    for (uint32_t s = 0; s < shapes().size(); ++s) {
        const Shape& shape = shapes()[s];
        if (shape.isEquality()) {
            addEqualityRows(shape, s);
            continue;
        }
        for (uint32_t leaf = 0; leaf < contacts_.leafCount(); ++leaf) {
            const dvec3 centre = kinematics_.leafNow(leaf, contacts_.leaves);
            std::array<SideGap, kMostSides> sides;
            const size_t count = sidesOf(shape, centre, contacts_.radius(leaf), sides);
            for (size_t k = 0; k < count; ++k) {
                if (sides[k].gap > 2.0 * options_.stepCap) {
                    continue;
                }
                out.escape = out.escape || sides[k].gap < -proxy::kNothing;
                ContactRow row;
                row.kind = ContactRow::Kind::Shape;
                row.normal = sides[k].normal;
                row.arm = kinematics_.lever(leaf, centre);
                row.gap = sides[k].gap;
                row.offset = offsetFor(row.gap);
                row.leaf = leaf;
                row.pair = s;
                row.key = rowKey(row.kind, s, leaf, k);
                addRow(row);
            }
        }
    }
}

// Lines and axes bind the tool or tip: two opposite rows per equation, which bring it back no faster than new
// data would push it out.
template <class Kinematics>
void ConstrainedProxy<Kinematics>::addEqualityRows(const Shape& shape, uint32_t index) noexcept {
    std::array<Equality, kMostEqualities> equalities;
    const size_t count = equalitiesOf(shape, kinematics_.pose(), equalities);
    for (size_t k = 0; k < count; ++k) {
        const Equality& e = equalities[k];
        const double limit = kinematics_.equalityLimit(e);
        const double wanted = std::clamp(-e.error, -limit, limit);
        for (const double sign : {1.0, -1.0}) {
            ContactRow row;
            row.kind = ContactRow::Kind::Equality;
            row.normal = sign * e.linear;
            row.spin = sign * e.angular;
            row.gap = -std::abs(e.error);
            // Less than wanted by a rounding error: two rows that meet exactly may seem to contradict.
            row.offset = sign * wanted - 1e-12;
            row.pair = index;
            row.key = rowKey(row.kind, index, 0, 2 * k + (sign > 0.0 ? 0 : 1));
            addRow(row);
        }
    }
}

// Cuts, checks, tightens and solves again until the exact check passes. On return `answer` holds the last
// solution; true when all of it passed.
template <class Kinematics>
bool ConstrainedProxy<Kinematics>::fitsExactly(Answer& answer, Step& out) noexcept {
    for (int round = 0;; ++round) {
        const bool inside = kinematics_.fit(answer, contacts_, rows_);
        if (allowed(inside)) {
            return true;
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

template <class Kinematics>
bool ConstrainedProxy<Kinematics>::allowed(bool insideTrustRegion) noexcept {
    return contacts_.check() == 0 && (insideTrustRegion || contacts_.insideTrustRegion()) && shapesAllow();
}

template <class Kinematics>
bool ConstrainedProxy<Kinematics>::shapesAllow() const noexcept {
    for (const Shape& shape : shapes()) {
        if (shape.isEquality()) {
            if (!equalityAllows(shape, kinematics_.pose(), kinematics_.nextPose())) {
                return false;
            }
            continue;
        }
        for (size_t leaf = 0; leaf < contacts_.leafCount(); ++leaf) {
            const double radius = contacts_.radius(leaf);
            const double gap = gapTo(shape, kinematics_.leafNext(leaf, contacts_.leaves), radius).gap;
            if (gap >= 0.0) {
                continue;
            }
            const dvec3 now = kinematics_.leafNow(leaf, contacts_.leaves);
            if (!(gap >= std::min(0.0, gapTo(shape, now, radius).gap))) {
                return false;
            }
        }
    }
    return true;
}

// Every violated pair gets a row, or its row asks for more: for what the leaf's actual way, arcs of rotation
// included, falls short of the pair's tangent plane. A way that stays on the free side of that plane cannot
// enter the sphere, so one round is enough for a pair unless others push it back. Sides of shapes and
// equations are treated alike. False when nothing could be asked for.
template <class Kinematics>
bool ConstrainedProxy<Kinematics>::tighten(const Answer& answer) noexcept {
    const double share = kinematics_.share(answer);
    bool changed = false;
    for (const NarrowPhase::Violation& violation : contacts_.violations()) {
        ContactRow row = violation.row;
        // Overlapping pairs without a row lie in the cone of one that has it: they need only not get deeper.
        const double needed = proxy::kSkin - std::max(0.0, row.gap);
        if (ContactRow* known = rows_.ofPair(row.pair)) {
            const double amount = kinematics_.shortfall(violation, needed, contacts_.leaves);
            known->offset = kinematics_.raised(known->offset, amount, share);
            changed = true;
        } else {
            row.offset = needed + kinematics_.arcOf(answer, row, contacts_.leaves);
            changed = addRow(row) || changed;
        }
    }
    const bool shapesChanged = tightenShapes(share);
    return kinematics_.tightenEqualities(shapes(), share, rows_) || shapesChanged || changed;
}

template <class Kinematics>
bool ConstrainedProxy<Kinematics>::tightenShapes(double share) noexcept {
    bool changed = false;
    for (size_t i = 0; i < rows_.size(); ++i) {
        ContactRow& row = rows_[i];
        if (row.kind != ContactRow::Kind::Shape) {
            continue;
        }
        std::array<SideGap, kMostSides> sides;
        const size_t side = static_cast<size_t>(row.key & 0xff);
        const dvec3 centre = kinematics_.leafNext(row.leaf, contacts_.leaves);
        if (side >= sidesOf(shapes()[row.pair], centre, contacts_.radius(row.leaf), sides)) {
            continue;
        }
        const double depth = std::min(0.0, row.gap) - sides[side].gap;
        if (depth > 0.0) {
            row.offset = kinematics_.raised(row.offset, depth, share);
            changed = true;
        }
    }
    return changed;
}

// Largest part of the step, to 1/2^14 of it, that passes the exact check and the trust region; 0 always does.
template <class Kinematics>
double ConstrainedProxy<Kinematics>::bisect(const Answer& answer) noexcept {
    double good = 0.0, bad = kinematics_.wholePart(answer);
    for (int k = 0; k < kBisections; ++k) {
        const double middle = 0.5 * (good + bad);
        kinematics_.tryPart(answer, middle, contacts_.leaves);
        (allowed(false) ? good : bad) = middle;
    }
    kinematics_.tryPart(answer, good, contacts_.leaves);
    return good;
}

} // namespace fathom
